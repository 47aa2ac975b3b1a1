#include "ros/markers/marker_shapes.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "test/ros/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

const MarkerStyle kStyle{"faces", "liver_frame", colours::kTool};

double brightness(const std_msgs::ColorRGBA& colour) {
  return 0.3 * colour.r + 0.6 * colour.g + 0.1 * colour.b;
}

}  // namespace

TEST(Colours, DepthsGetDarkerAndAreClamped) {
  for (int i = 0; i < 100; ++i) {
    const auto shallow = colours::depth(0.01 * i), deep = colours::depth(0.01 * (i + 1));
    EXPECT_GT(brightness(shallow), brightness(deep)) << i;
    EXPECT_EQ(shallow.a, 1.0f);
  }
  EXPECT_EQ(colours::depth(-3.0), colours::depth(0.0));
  EXPECT_EQ(colours::depth(std::numeric_limits<double>::infinity()), colours::depth(1.0));
}

TEST(Colours, NeighbouringOrgansDiffer) {
  for (std::size_t i = 0; i < 12; ++i) EXPECT_FALSE(colours::tissue(i) == colours::tissue(i + 1));
}

TEST(Colours, FadingChangesOnlyTheOpacity) {
  auto half = colours::faded(colours::kSwept, 0.5);
  EXPECT_FLOAT_EQ(half.a, 0.5f * colours::kSwept.a);
  half.a = colours::kSwept.a;
  EXPECT_EQ(half, colours::kSwept);
}

TEST(Visibility, FallsFromOneToZero) {
  EXPECT_EQ(visibility(at(0.0), at(0.0)), 1.0);
  EXPECT_NEAR(visibility(at(0.0), at(0.25 * kFadeSec)), 0.75, 1e-6);
  EXPECT_EQ(visibility(at(0.0), at(2.0 * kFadeSec)), 0.0);
  EXPECT_EQ(visibility(at(1.0), at(0.0)), 1.0);
}

TEST(Markers, AreNumberedInEachNamespace) {
  MarkerArray picture;
  for (const char* name : {"a", "b", "a", "a"}) {
    add_marker(make_marker({name, "liver", colours::kTool}, Marker::CUBE), picture);
  }
  ASSERT_EQ(picture.markers.size(), 4u);
  const int ids[] = {0, 0, 1, 2};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(picture.markers[i].id, ids[i]);
}

TEST(Markers, ListsWithoutPointsAndArrowsWithoutLengthAreLeftOut) {
  MarkerArray picture;
  Marker list = make_marker(kStyle, Marker::TRIANGLE_LIST);
  add_marker(list, picture);
  add_arrow(kStyle, Vector3d::Ones(), Vector3d::Ones(), {}, picture);
  EXPECT_TRUE(picture.markers.empty());
  add_point(list, {0.5, 0.25, 2.0});
  add_marker(list, picture);
  ASSERT_EQ(picture.markers.size(), 1u);
  EXPECT_EQ(point(picture.markers[0], 0), Vector3d(0.5, 0.25, 2.0));
}

TEST(Markers, FollowTheLatestTransformOfTheirFrame) {
  const Marker marker = make_marker(kStyle, Marker::SPHERE);
  EXPECT_EQ(marker.header.frame_id, "liver_frame");
  EXPECT_TRUE(marker.header.stamp.isZero());
  EXPECT_TRUE(marker.frame_locked);
  EXPECT_EQ(marker.pose.orientation.w, 1.0);
}

TEST(Markers, AnArrowIsAsWideAsItsLengthTells) {
  MarkerArray picture;
  add_arrow(kStyle, {1, 0, 0}, {1, 0, 2}, {0.1, 0.2, 0.3}, picture);
  const Marker& arrow = picture.markers.at(0);
  EXPECT_EQ(arrow.type, Marker::ARROW);
  EXPECT_DOUBLE_EQ(arrow.scale.x, 0.2);
  EXPECT_DOUBLE_EQ(arrow.scale.y, 0.4);
  EXPECT_DOUBLE_EQ(arrow.scale.z, 0.6);
  EXPECT_EQ(point(arrow, 0), Vector3d(1, 0, 0));
  EXPECT_EQ(point(arrow, 1), Vector3d(1, 0, 2));
}

TEST(LiftedFace, IsOnBothSidesOfTheSurface) {
  Marker list = make_marker(kStyle, Marker::TRIANGLE_LIST);
  add_lifted_face(square(), 1, colours::kNearFace, list);
  ASSERT_EQ(list.points.size(), 6u);
  const Triangle corners = square().mesh->triangle(1);
  for (std::size_t i = 0; i < 6; ++i) {
    const Vector3d lift = point(list, i) - corners[i % 3];
    EXPECT_NEAR(lift.z(), (i < 3 ? 1e-3 : -1e-3) * square().size(), 1e-7);
    EXPECT_NEAR(lift.head<2>().norm(), 0.0, 1e-12);
    EXPECT_EQ(list.colors.at(i), colours::kNearFace);
  }
}

TEST(LiftedFace, ADegenerateFaceIsFinite) {
  SceneOrgan organ = square();
  organ.mesh =
      std::make_shared<const TriangleMesh>(TriangleMesh({0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2}));
  Marker list = make_marker(kStyle, Marker::TRIANGLE_LIST);
  add_lifted_face(organ, 0, colours::kNearFace, list);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(point(list, i).allFinite());
}
