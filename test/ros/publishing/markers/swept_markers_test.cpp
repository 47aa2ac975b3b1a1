#include "ros/publishing/markers/swept_markers.hpp"

#include <gtest/gtest.h>

#include "ros/publishing/markers/colours.hpp"
#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;

namespace {

SceneStep step(double seconds, const ToolPath& path) {
  return {at(seconds), answer_with({}), square().faces, path, 0.0};
}

Marker swept(const Tool& tool, const std::vector<SceneStep>& steps, double now) {
  std::vector<const SceneStep*> pointers;
  for (const SceneStep& step : steps) pointers.push_back(&step);
  MarkerSheet sheet;
  add_swept(tool, pointers, "liver_frame", at(now), sheet);
  return find_marker(sheet.markers(), "swept");
}

const Tool kHook = shaft_tool("hook", 0.25);
const ShaftAxis kBegin{{0, 0, 1}, {0, 0, 0}}, kTurned{{0, 0, 1}, {1, 0, 0}};
const ShaftAxis kMoved{{0, 2, 1}, {1, 2, 0}};

}  // namespace

TEST(SweptMarkers, EachLegSweepsATriangleOrAQuadrangle) {
  const Marker marker =
      swept(kHook, {step(0.0, {{0.0, kBegin}, {0.5, kTurned}, {1.0, kMoved}})}, 0.1);
  ASSERT_EQ(marker.points.size(), 9u);
  EXPECT_EQ(marker.colors.size(), 9u);
}

TEST(SweptMarkers, TheTrailFades) {
  const ToolPath turn{{0.0, kBegin}, {1.0, kTurned}};
  const Marker marker = swept(kHook, {step(-9.0, turn), step(0.0, turn), step(0.2, turn)}, 0.3);
  ASSERT_EQ(marker.colors.size(), 6u);  // Nothing is left of the first step.
  const float full = colours::swept().a;
  EXPECT_NEAR(marker.colors[0].a, full * (1.0 - 0.1 / kFadeSec), 1e-5);
  EXPECT_NEAR(marker.colors[3].a, full * (1.0 - 0.3 / kFadeSec), 1e-5);
}

TEST(SweptMarkers, ALongTrailIsCut) {
  ToolPath path;
  for (int i = 0; i < 3000; ++i) path.push_back({i / 2999.0, i % 2 ? kBegin : kTurned});
  EXPECT_EQ(swept(kHook, {step(0.0, path)}, 0.0).points.size(), 3 * kMostLegs);
}

TEST(SweptMarkers, AToolAtRestSweepsNothing) {
  EXPECT_EQ(swept(kHook, {step(0.0, {{0.0, kBegin}}), step(0.0, {})}, 0.0).type, -1);
  EXPECT_EQ(swept(kHook, {step(0.0, {{0.0, kBegin}, {1.0, kBegin}})}, 0.0).type, -1);
}

TEST(SweptMarkers, LinksSweepWithTheirLongestAxis) {
  Tool tool = grasper();
  tool.links = {{"jaw", {LinkPart::box(Eigen::Isometry3d::Identity(), {0.01, 0.2, 0.02})}}};
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.translation().x() = 0.5;
  const Marker marker = swept(
      tool, {step(0.0, {{0.0, {}, {Eigen::Isometry3d::Identity()}}, {1.0, {}, {moved}}})}, 0.0);
  ASSERT_EQ(marker.points.size(), 6u);
  double area = 0.0;
  for (std::size_t i = 0; i < 6; i += 3) {
    const Eigen::Vector3d a = point(marker, i);
    area += 0.5 * (point(marker, i + 1) - a).cross(point(marker, i + 2) - a).norm();
  }
  EXPECT_NEAR(area, 0.5 * 0.2, 1e-6);
}

TEST(Visibility, FallsFromOneToZero) {
  EXPECT_EQ(visibility(at(0.0), at(0.0)), 1.0);
  EXPECT_NEAR(visibility(at(0.0), at(0.25 * kFadeSec)), 0.75, 1e-6);
  EXPECT_EQ(visibility(at(0.0), at(2.0 * kFadeSec)), 0.0);
  EXPECT_EQ(visibility(at(1.0), at(0.0)), 1.0);
}
