#include "ros/publishing/markers/tool_markers.hpp"

#include <gtest/gtest.h>

#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

namespace {

std::vector<Marker> markers(const Tool& tool, const ToolPose& pose) {
  MarkerSheet sheet;
  add_tool(tool, pose, "liver_frame", sheet);
  for (const Marker& marker : sheet.markers().markers) {
    EXPECT_EQ(marker.ns, "tools");
    EXPECT_EQ(marker.header.frame_id, "liver_frame");
  }
  return sheet.markers().markers;
}

Isometry3d pose_of(const Marker& marker) {
  const auto& p = marker.pose.position;
  const auto& q = marker.pose.orientation;
  Isometry3d pose(Eigen::Translation3d(p.x, p.y, p.z));
  pose.rotate(Eigen::Quaterniond(q.w, q.x, q.y, q.z));
  return pose;
}

Isometry3d tilted() {
  Isometry3d pose(Eigen::Translation3d(0.3, -0.1, 0.2));
  pose.rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()));
  return pose;
}

/// The marker of a tool with one link of one part.
Marker marker_of(const LinkPart& part) {
  Tool tool = grasper();
  tool.links = {{"jaw", {part}}};
  const auto all = markers(tool, {{}, {tilted()}});
  EXPECT_EQ(all.size(), 1u);
  return all.front();
}

}  // namespace

TEST(ToolMarkers, AShaftIsACapsule) {
  const auto shaft = markers(shaft_tool("hook", 0.25), {{{0, 0, 2}, {0, 4, 2}}, {}});
  ASSERT_EQ(shaft.size(), 3u);
  EXPECT_EQ(shaft[0].type, Marker::CYLINDER);
  EXPECT_DOUBLE_EQ(shaft[0].scale.x, 0.5);
  EXPECT_DOUBLE_EQ(shaft[0].scale.z, 4.0);
  EXPECT_TRUE((pose_of(shaft[0]) * Vector3d(0, 0, 2)).isApprox(Vector3d(0, 4, 2), 1e-12));
  EXPECT_EQ(shaft[1].type, Marker::SPHERE);
  EXPECT_DOUBLE_EQ(shaft[2].pose.position.y, 4.0);
  EXPECT_DOUBLE_EQ(shaft[2].scale.y, 0.5);
}

TEST(ToolMarkers, ABallHasAShaftWithoutLength) {
  const auto shaft = markers(shaft_tool("hook", 0.25), {{{1, 2, 3}, {1, 2, 3}}, {}});
  EXPECT_GT(shaft[0].scale.z, 0.0);
  EXPECT_TRUE(pose_of(shaft[0]).linear().isUnitary(1e-12));
}

TEST(ToolMarkers, ALinkMayBeASphere) {
  const Marker ball = marker_of(LinkPart::sphere({0.1, 0.2, 0.3}, 0.05));
  EXPECT_EQ(ball.type, Marker::SPHERE);
  EXPECT_DOUBLE_EQ(ball.scale.x, 0.1);
  EXPECT_TRUE(pose_of(ball).translation().isApprox(tilted() * Vector3d(0.1, 0.2, 0.3), 1e-12));
}

TEST(ToolMarkers, ALinkMayBeACylinder) {
  const Isometry3d place(Eigen::Translation3d(0.0, 0.1, 0.0));
  const Marker cylinder = marker_of(LinkPart::cylinder(place, 0.02, 0.3));
  EXPECT_EQ(cylinder.type, Marker::CYLINDER);
  EXPECT_NEAR(cylinder.scale.x, 0.04, 1e-5);
  EXPECT_NEAR(cylinder.scale.z, 0.3, 1e-5);
  const Vector3d end = tilted() * Vector3d(0.0, 0.1, 0.15);
  EXPECT_TRUE((pose_of(cylinder) * Vector3d(0, 0, 0.15)).isApprox(end, 1e-4));
}

TEST(ToolMarkers, ALinkMayBeABox) {
  const Marker box = marker_of(LinkPart::box(Isometry3d::Identity(), {0.1, 0.2, 0.3}));
  EXPECT_EQ(box.type, Marker::CUBE);
  // The marker's axes may be those of the box in another order.
  const Vector3d size(box.scale.x, box.scale.y, box.scale.z);
  const Vector3d extent = (tilted().linear().transpose() * pose_of(box).linear() * size).cwiseAbs();
  EXPECT_TRUE(extent.isApprox(Vector3d(0.1, 0.2, 0.3), 1e-4)) << extent.transpose();
}

TEST(ToolMarkers, ALinkMayBeAMesh) {
  const Marker mesh =
      marker_of(LinkPart::mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {FaceIndices{0, 1, 2}}}));
  EXPECT_EQ(mesh.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(mesh.points.size(), 3u);
  EXPECT_TRUE(pose_of(mesh).isApprox(tilted(), 1e-12));
}

TEST(ToolMarkers, ALargeMeshIsABox) {
  const std::vector<FaceIndices> faces(kMostFacesOfTool + 1, {0, 1, 2});
  EXPECT_EQ(marker_of(LinkPart::mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, faces})).type,
            Marker::CUBE);
}
