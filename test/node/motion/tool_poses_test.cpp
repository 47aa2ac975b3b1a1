#include "node/motion/tool_poses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/tool/leg_motion.hpp"
#include "test/node/tools/hand_made_tools.hpp"
#include "tool_poses_fixture.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

const Isometry3d kWorldLiver = Eigen::Translation3d(0.3, 0.1, -0.4) *
                               Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, 2.0, -0.5).normalized());

Isometry3d turn(double angle, const Vector3d& axis) {
  return Isometry3d(Eigen::AngleAxisd(angle, axis.normalized()));
}

/// The grasper, whose links have a tip in a frame of its own.
Tool tipped_grasper() {
  Tool tool = grasper();
  tool.parameters.tip_frame = "jaw_tip";
  return tool;
}

/// A liver that rests in the world; a shaft whose tip moves on an arc around its trocar; a wrist
/// that turns, and a jaw that turns on it.
class ToolPosesTest : public testing::Test {
 protected:
  ToolPosesTest() { set_transform(buffer_, "world", "liver", 0.0, kWorldLiver, true); }

  static Vector3d trocar(double time) { return {0.1, 0.2 + 0.01 * time, 0.5}; }
  static Vector3d tip(double time) {
    return trocar(time) + 0.3 * Vector3d(std::sin(time), 0.2, -std::cos(time));
  }
  static Isometry3d wrist(double time) {
    return Eigen::Translation3d(0.1, 0.2, 0.5) * turn(std::sin(time), {0.2, 1.0, -0.3});
  }
  static Isometry3d jaw_on_wrist(double time) {
    return Eigen::Translation3d(0.0, 0.01, 0.05) * turn(2.0 * time, {1.0, 0.1, 0.2});
  }
  static Vector3d jaw_tip(double time) { return {0.1 + 0.2 * time, 0.3, -0.1 * time}; }

  void send_trocar(double time) { set_point(buffer_, "world", "hook_trocar", time, trocar(time)); }
  void send_tip(double time) { set_point(buffer_, "world", "hook_tip", time, tip(time)); }
  void send_wrist(double time) { set_transform(buffer_, "world", "arm/wrist", time, wrist(time)); }
  void send_jaw(double time) {
    set_transform(buffer_, "arm/wrist", "arm/jaw", time, jaw_on_wrist(time));
  }
  void send_jaw_tip(double time) { set_point(buffer_, "world", "jaw_tip", time, jaw_tip(time)); }
  void send_shaft(double time) {
    send_trocar(time);
    send_tip(time);
  }
  void send_links(double time) {
    send_wrist(time);
    send_jaw(time);
  }

  /// The pose of the shaft and the links, or of the links alone.
  static ToolPose pose_at(double time) {
    const Isometry3d T_liver_world = kWorldLiver.inverse();
    return {{T_liver_world * trocar(time), T_liver_world * tip(time)},
            {T_liver_world * wrist(time), T_liver_world * wrist(time) * jaw_on_wrist(time)}};
  }
  static void expect_axis(const ShaftAxis& axis, double time, double tolerance = 1e-9) {
    EXPECT_LT((axis.trocar - pose_at(time).axis.trocar).norm(), tolerance);
    EXPECT_LT((axis.tip - pose_at(time).axis.tip).norm(), tolerance);
  }
  static void expect_links(const std::vector<Isometry3d>& links, double time,
                           double tolerance = 1e-9) {
    const std::vector<Isometry3d> expected = pose_at(time).links;
    ASSERT_EQ(links.size(), expected.size());
    for (std::size_t i = 0; i < links.size(); ++i) {
      EXPECT_LT((links[i].matrix() - expected[i].matrix()).norm(), tolerance) << "link " << i;
    }
  }

  SampledPath path(const Tool& tool, double from, double to, const PathSampling& sampling) {
    return ToolPoses(buffer_, sampling)
        .path(tool, "liver", {pose_at(from), ros::Time(from)}, {pose_at(to), ros::Time(to)});
  }
  std::string why_not(const Tool& tool, double time, const std::string& organ = "liver") {
    const auto lookup = poses_.pose(tool, organ, ros::Time(time));
    EXPECT_FALSE(lookup.found);
    return lookup.why_not;
  }

  const Tool hook_ = shaft_tool("hook", 0.005), grasper_ = grasper(), tipped_ = tipped_grasper();
  TransformBuffer buffer_;
  ToolPoses poses_{buffer_, {0.001, 100}};
};

}  // namespace

TEST_F(ToolPosesTest, ShaftLinksAndTipInTheOrgansFrame) {
  for (const double time : {1.0, 2.0}) {
    send_shaft(time);
    send_links(time);
    send_jaw_tip(time);
  }
  const auto both = poses_.pose(with_links(hook_), "liver", ros::Time(1.0));
  ASSERT_TRUE(both.found) << both.why_not;
  expect_axis(both.found->value.axis, 1.0);
  expect_links(both.found->value.links, 1.0);
  EXPECT_FALSE(both.found->value.tip);
  EXPECT_EQ(both.found->stamp, ros::Time(1.0));
  EXPECT_TRUE(poses_.has_pose(with_links(hook_), "liver", ros::Time(1.0)));
  EXPECT_TRUE(poses_.has_pose(tipped_, "liver", ros::Time(1.0)));
  EXPECT_FALSE(poses_.has_pose(tipped_, "liver", ros::Time(2.001)));
  const auto tipped = poses_.pose(tipped_, "liver", ros::Time(1.0));
  ASSERT_TRUE(tipped.found && tipped.found->value.tip) << tipped.why_not;
  EXPECT_LT((*tipped.found->value.tip - kWorldLiver.inverse() * jaw_tip(1.0)).norm(), 1e-9);
}

TEST_F(ToolPosesTest, TipAndTrocarMayBePointsOfTheirFrames) {
  const Vector3d tip(0.02, -0.013, 0.17), trocar(0.0, 0.01, 0.03);
  Tool pointer = shaft_tool("pointer", 0.001), arm = tipped_;
  pointer.parameters.trocar_frame = pointer.parameters.tip_frame = "marker";
  pointer.parameters.tip_offset = tip;
  pointer.parameters.trocar_offset = trocar;
  arm.parameters.tip_frame = "arm/jaw";
  arm.parameters.tip_offset = tip;
  set_transform(buffer_, "world", "marker", 1.0, wrist(1.0));
  send_links(1.0);
  const auto found = poses_.pose(pointer, "liver", ros::Time(1.0));
  ASSERT_TRUE(found.found) << found.why_not;
  const Isometry3d T_liver_marker = kWorldLiver.inverse() * wrist(1.0);
  EXPECT_LT((found.found->value.axis.tip - T_liver_marker * tip).norm(), 1e-9);
  EXPECT_LT((found.found->value.axis.trocar - T_liver_marker * trocar).norm(), 1e-9);
  const auto tipped = poses_.pose(arm, "liver", ros::Time(1.0));
  ASSERT_TRUE(tipped.found && tipped.found->value.tip) << tipped.why_not;
  EXPECT_LT((*tipped.found->value.tip - tipped.found->value.links[1] * tip).norm(), 1e-9);
}

TEST_F(ToolPosesTest, LatestIsTheLatestThatAllFramesHave) {
  // The wrist rests, at its pose of this time.
  set_transform(buffer_, "world", "arm/wrist", 0.0, wrist(1.5), true);
  for (const double time : {1.0, 1.25, 1.5, 2.0, 2.5}) {
    send_shaft(time);
    if (time <= 2.0) send_jaw(time);
    if (time <= 1.5) send_jaw_tip(time);
  }
  for (const auto& [tool, latest] : {std::pair(hook_, 2.5), std::pair(with_links(hook_), 2.0),
                                     std::pair(grasper_, 2.0), std::pair(tipped_, 1.5)}) {
    const auto lookup = poses_.pose(tool, "liver", ros::Time(0));
    ASSERT_TRUE(lookup.found) << lookup.why_not;
    EXPECT_EQ(lookup.found->stamp, ros::Time(latest));
    if (tool.parameters.has_shaft()) expect_axis(lookup.found->value.axis, latest);
    if (latest == 1.5) expect_links(lookup.found->value.links, latest);
  }
}

TEST_F(ToolPosesTest, WhatIsMissingIsNamed) {
  send_tip(1.0);
  EXPECT_EQ(why_not(hook_, 1.0), "frame 'hook_trocar' is unknown to TF");
  EXPECT_EQ(why_not(grasper_, 1.0),
            "link 'wrist' of tool 'grasper': frame 'arm/wrist' is unknown to TF");
  send_wrist(1.0);
  EXPECT_EQ(why_not(grasper_, 1.0),
            "link 'jaw' of tool 'grasper' (is joint 'jaw_joint' published?): "
            "frame 'arm/jaw' is unknown to TF");
  send_jaw(1.0);
  EXPECT_EQ(why_not(tipped_, 1.0), "tip of tool 'grasper': frame 'jaw_tip' is unknown to TF");
  EXPECT_TRUE(poses_.has_pose(grasper_, "liver", ros::Time(1.0)));
  EXPECT_FALSE(poses_.has_pose(tipped_, "liver", ros::Time(1.0)));
  EXPECT_EQ(why_not(grasper_, 1.0, "kidney"),
            "frame 'kidney' is unknown to TF; it is the frame of the organ or of the node, not of "
            "the tool");
  EXPECT_EQ(why_not(tipped_, 1.0, "kidney"), why_not(grasper_, 1.0, "kidney"));
  send_wrist(1.1);
  EXPECT_EQ(why_not(grasper_, 1.007),  // The joint is published, but late.
            "link 'jaw' of tool 'grasper': TF from 'arm/jaw' to 'liver' is 7 ms behind the "
            "stamp 1.007000000");
  Tool silent = shaft_tool("needle", 0.005);
  silent.parameters.trocar_frame = "hook_tip";
  silent.parameters.tip_pose_topic = "/arm/measured_cp";
  EXPECT_EQ(why_not(silent, 1.0), "no pose came on /arm/measured_cp");
}

TEST_F(ToolPosesTest, EveryPoseThatTfWasToldIsAWaypoint) {
  const double times[] = {1.0, 1.013, 1.0134, 1.02, 1.071, 1.1};
  for (const double time : times) send_shaft(time);
  set_point(buffer_, "world", "other", 1.05, {1.0, 2.0, 3.0});
  const SampledPath sampled = path(hook_, 1.0, 1.1, {0.01, 100});
  // The even samples in between lie on straight lines, so they are dropped.
  ASSERT_EQ(sampled.path.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(sampled.path[i].fraction, (times[i] - 1.0) / 0.1, 1e-7);
    expect_axis(sampled.path[i].axis, times[i], 1e-7);
  }
}

TEST_F(ToolPosesTest, OfTooManyPosesThoseThatMatterMostStay) {
  for (int i = 0; i <= 100; ++i) {
    const double time = 1.0 + 0.001 * i;
    send_trocar(time);
    const double stab = i == 37 ? 0.3 : 0.0, wobble = i % 2 == 0 ? 0.0 : 1e-6;
    set_point(buffer_, "world", "hook_tip", time, trocar(time) - Vector3d(0.0, wobble, 0.1 + stab));
  }
  const auto known = [&](double time) {
    return *poses_.pose(hook_, "liver", ros::Time(time)).found;
  };
  const SampledPath sampled =
      ToolPoses(buffer_, {1.0, 4}).path(hook_, "liver", known(1.0), known(1.1));
  ASSERT_EQ(sampled.path.size(), 5u);
  for (int i = 1; i <= 3; ++i) EXPECT_NEAR(sampled.path[i].fraction, 0.35 + 0.01 * i, 1e-7);
  EXPECT_EQ(sampled.samples_cut, 96u);
  EXPECT_GE(sampled.deviation_cut, 0.5e-6);
  EXPECT_LE(sampled.deviation_cut, 1e-6 + 1e-12);
  const SampledPath straight =
      ToolPoses(buffer_, {1.0, 1}).path(hook_, "liver", known(1.0), known(1.1));
  EXPECT_EQ(straight.unknown,
            "99 of the tool's poses in this step were left out (motion_samples_max), the farthest "
            "is 300 mm from the tested path");
}

TEST_F(ToolPosesTest, ASampleOutOfAllBoundsIsLeftOut) {
  for (const double time : {1.0, 1.25, 1.75, 2.0}) {
    send_shaft(time);
    send_links(time);
  }
  send_trocar(1.5);
  send_wrist(1.5);
  for (const char* frame : {"hook_tip", "arm/jaw"}) {
    const std::string parent = frame == std::string("arm/jaw") ? "arm/wrist" : "world";
    set_point(buffer_, parent, frame, 1.5, {0.0, 1e9, 0.0});
  }
  for (const Tool& tool : {hook_, grasper_}) {
    const SampledPath sampled = path(tool, 1.0, 2.0, {0.25, 100});
    EXPECT_NE(sampled.unknown.find("1.5"), std::string::npos) << sampled.unknown;
    // The links of the grasper turn, and have waypoints in between.
    const auto after = std::find_if(sampled.path.begin(), sampled.path.end(),
                                    [](const auto& waypoint) { return waypoint.fraction > 0.25; });
    ASSERT_NE(after, sampled.path.end());
    EXPECT_DOUBLE_EQ((after - 1)->fraction, 0.25);
    EXPECT_DOUBLE_EQ(after->fraction, 0.75);
  }
}
