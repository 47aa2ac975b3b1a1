#include "ros/markers/marker_shapes.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "hand_made_scenes.hpp"

using namespace organ_collision;

namespace {

double brightness(const std_msgs::ColorRGBA& colour) {
  return 0.3 * colour.r + 0.6 * colour.g + 0.1 * colour.b;
}

}  // namespace

TEST(Colours, DepthsGetDarker) {
  for (int i = 0; i < 100; ++i) {
    const auto shallow = colours::depth(0.01 * i), deep = colours::depth(0.01 * (i + 1));
    EXPECT_GT(brightness(shallow), brightness(deep)) << i;
    EXPECT_EQ(shallow.a, 1.0f);
  }
}

TEST(Colours, DepthsBeyondTheMapAreClamped) {
  EXPECT_EQ(colours::depth(-3.0), colours::depth(0.0));
  EXPECT_EQ(colours::depth(7.0), colours::depth(1.0));
  EXPECT_EQ(colours::depth(std::numeric_limits<double>::infinity()), colours::depth(1.0));
}

TEST(Colours, NeighbouringOrgansDiffer) {
  for (std::size_t i = 0; i < 12; ++i) EXPECT_FALSE(colours::tissue(i) == colours::tissue(i + 1));
}

TEST(Colours, FadingChangesOnlyTheOpacity) {
  auto half = colours::faded(colours::swept(), 0.5);
  EXPECT_FLOAT_EQ(half.a, 0.5f * colours::swept().a);
  half.a = colours::swept().a;
  EXPECT_EQ(half, colours::swept());
}

using namespace organ_collision;
using visualization_msgs::Marker;

TEST(MarkerSheet, NumbersTheMarkersOfEachNamespace) {
  MarkerSheet sheet;
  for (const char* name : {"a", "b", "a", "a"}) {
    sheet.add(make_marker(name, "liver", Marker::CUBE, colours::tool()));
  }
  const auto& markers = sheet.markers().markers;
  ASSERT_EQ(markers.size(), 4u);
  EXPECT_EQ(markers[0].id, 0);
  EXPECT_EQ(markers[1].id, 0);
  EXPECT_EQ(markers[2].id, 1);
  EXPECT_EQ(markers[3].id, 2);
}

TEST(MarkerSheet, DropsEmptyLists) {
  MarkerSheet sheet;
  Marker list = make_marker("a", "liver", Marker::TRIANGLE_LIST, colours::tool());
  sheet.add(list);
  EXPECT_TRUE(sheet.markers().markers.empty());
  add_point(list, {0.5, 0.25, 2.0});
  sheet.add(list);
  ASSERT_EQ(sheet.markers().markers.size(), 1u);
  EXPECT_EQ(sheet.markers().markers[0].points[0].z, 2.0);
}

TEST(MarkerSheet, IsEmptyWhenItsMarkersAreTaken) {
  MarkerSheet sheet;
  sheet.add(make_marker("a", "liver", Marker::CUBE, colours::tool()));
  EXPECT_EQ(sheet.take().markers.size(), 1u);
  EXPECT_TRUE(sheet.markers().markers.empty());
}

TEST(MarkerSheet, MarkersFollowTheLatestTransformOfTheirFrame) {
  const Marker marker = make_marker("a", "liver", Marker::SPHERE, colours::tool());
  EXPECT_EQ(marker.header.frame_id, "liver");
  EXPECT_TRUE(marker.header.stamp.isZero());
  EXPECT_TRUE(marker.frame_locked);
  EXPECT_EQ(marker.pose.orientation.w, 1.0);
}

using namespace organ_collision;
using Eigen::Vector3d;

TEST(Arrow, IsAClosedSolidBetweenItsEnds) {
  const Vector3d tail(0.3, -0.2, 0.1), head(0.5, 0.4, -0.6);
  visualization_msgs::Marker list;
  add_arrow(tail, head, list);
  ASSERT_EQ(list.points.size() % 3, 0u);
  const Vector3d axis = (head - tail).normalized();
  double volume = 0.0, farthest = 0.0;
  for (std::size_t i = 0; i < list.points.size(); i += 3) {
    const Vector3d a = point(list, i), b = point(list, i + 1), c = point(list, i + 2);
    volume += (a - tail).dot((b - tail).cross(c - tail)) / 6.0;
    for (const Vector3d& corner : {a, b, c}) {
      const double along = axis.dot(corner - tail);
      EXPECT_GE(along, -1e-12);
      EXPECT_LE(along, (head - tail).norm() + 1e-12);
      farthest = std::max(farthest, along);
    }
  }
  EXPECT_GT(volume, 0.0);  // The faces point outward.
  EXPECT_NEAR(farthest, (head - tail).norm(), 1e-12);
}

TEST(Arrow, HasNoTrianglesWithoutLength) {
  visualization_msgs::Marker list;
  add_arrow(Vector3d::Ones(), Vector3d::Ones(), list);
  EXPECT_TRUE(list.points.empty());
}

TEST(ArrowHead, EndsAtItsApex) {
  const Vector3d base(0.3, -0.2, 0.1), apex(0.5, 0.4, -0.6);
  visualization_msgs::Marker list;
  add_arrow_head(base, apex, 0.05, list);
  const Vector3d axis = (apex - base).normalized();
  double farthest = 0.0, widest = 0.0;
  for (std::size_t i = 0; i < list.points.size(); ++i) {
    const double along = axis.dot(point(list, i) - base);
    EXPECT_GE(along, -1e-12);
    farthest = std::max(farthest, along);
    widest = std::max(widest, axis.cross(point(list, i) - base).norm());
  }
  EXPECT_NEAR(farthest, (apex - base).norm(), 1e-12);
  EXPECT_NEAR(widest, 0.05, 1e-12);
  visualization_msgs::Marker none;
  add_arrow_head(base, base, 0.05, none);
  EXPECT_TRUE(none.points.empty());
}

using namespace organ_collision;

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
