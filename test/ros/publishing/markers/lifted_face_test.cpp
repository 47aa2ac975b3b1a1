#include "ros/publishing/markers/lifted_face.hpp"

#include <gtest/gtest.h>

#include "ros/publishing/markers/colours.hpp"
#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;

TEST(LiftedFace, IsOnBothSidesOfTheSurface) {
  Marker list = make_marker("faces", "liver_frame", Marker::TRIANGLE_LIST, colours::tool());
  add_lifted_face(square(), 1, colours::near_face(), list);
  ASSERT_EQ(list.points.size(), 6u);
  const Triangle corners = square().triangle(1);
  for (std::size_t i = 0; i < 6; ++i) {
    const Eigen::Vector3d lift = point(list, i) - corners[i % 3];
    EXPECT_NEAR(lift.z(), (i < 3 ? 1e-3 : -1e-3) * square().size(), 1e-7);
    EXPECT_NEAR(lift.head<2>().norm(), 0.0, 1e-12);
    EXPECT_EQ(list.colors.at(i), colours::near_face());
  }
}

TEST(LiftedFace, ADegenerateFaceIsFinite) {
  SceneOrgan organ = square();
  const TriangleMesh needle({0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2});
  organ.vertices = needle.shared_vertices();
  organ.faces = needle.shared_faces();
  Marker list = make_marker("faces", "liver_frame", Marker::TRIANGLE_LIST, colours::tool());
  add_lifted_face(organ, 0, colours::near_face(), list);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(point(list, i).allFinite());
}
