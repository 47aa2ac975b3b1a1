#include "organ_collision/ros/tool_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hand_filled_transforms.hpp"
#include "hand_made_tools.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

Tool hook() {
  Tool tool;
  tool.parameters = {"hook", "trocar", "tip", 0.005};
  return tool;
}
const Tool kTool = hook();
const Isometry3d kWorldLiver = Eigen::Translation3d(0.3, 0.1, -0.4) *
                               Eigen::AngleAxisd(0.8, Vector3d(1.0, 2.0, -0.5).normalized());

/// A liver that rests in the world, and a tool whose tip moves on an arc around its trocar.
class ToolPosesTest : public testing::Test {
 protected:
  ToolPosesTest() { set_transform(buffer_, "world", "liver", 0.0, kWorldLiver, true); }

  static Vector3d trocar(double time) { return {0.1, 0.2 + 0.01 * time, 0.5}; }
  static Vector3d tip(double time) {
    return trocar(time) + 0.3 * Vector3d(std::sin(time), 0.2, -std::cos(time));
  }
  static ShaftAxis axis_in_liver(double time) {
    return {kWorldLiver.inverse() * trocar(time), kWorldLiver.inverse() * tip(time)};
  }
  void send_trocar(double time) { set_point(buffer_, "world", "trocar", time, trocar(time)); }
  void send_tip(double time) { set_point(buffer_, "world", "tip", time, tip(time)); }
  void send(double time) {
    send_trocar(time);
    send_tip(time);
  }
  static void expect_axis(const ShaftAxis& axis, const ShaftAxis& expected,
                          double tolerance = 1e-9) {
    EXPECT_LT((axis.trocar - expected.trocar).norm(), tolerance);
    EXPECT_LT((axis.tip - expected.tip).norm(), tolerance);
  }
  SampledPath path(double from, double to, const PathSampling& sampling) const {
    return ToolPoses(buffer_, sampling)
        .path(kTool, "liver", {{axis_in_liver(from)}, ros::Time(from)},
              {{axis_in_liver(to)}, ros::Time(to)});
  }

  tf2::BufferCore buffer_;
  ToolPoses poses_{buffer_, {0.001, 100}};
};

}  // namespace

TEST_F(ToolPosesTest, AxisInTheOrgansFrame) {
  send(1.0);
  send(2.0);
  const auto lookup = poses_.pose(kTool, "liver", ros::Time(2.0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  expect_axis(lookup.found->value.axis, axis_in_liver(2.0));
  EXPECT_EQ(lookup.found->stamp, ros::Time(2.0));
}

TEST_F(ToolPosesTest, LatestIsTheLatestThatBothFramesHave) {
  for (const double time : {1.0, 1.5, 2.0}) send_trocar(time);
  for (const double time : {1.0, 1.5}) send_tip(time);
  const auto lookup = poses_.pose(kTool, "liver", ros::Time(0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  EXPECT_EQ(lookup.found->stamp, ros::Time(1.5));
  expect_axis(lookup.found->value.axis, axis_in_liver(1.5));
}

TEST_F(ToolPosesTest, RestingTrocarTakesTheTipsTime) {
  set_point(buffer_, "world", "trocar", 0.0, trocar(1.5), true);
  send_tip(1.5);
  const auto lookup = poses_.pose(kTool, "liver", ros::Time(0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  EXPECT_EQ(lookup.found->stamp, ros::Time(1.5));
  expect_axis(lookup.found->value.axis, axis_in_liver(1.5));
}

TEST_F(ToolPosesTest, AToolThatOnlyRestsIsOfAnyTime) {
  set_point(buffer_, "world", "trocar", 0.0, trocar(0.0), true);
  set_point(buffer_, "trocar", "tip", 0.0, tip(0.0) - trocar(0.0), true);
  const auto lookup = poses_.pose(kTool, "liver", ros::Time(0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  EXPECT_TRUE(lookup.found->stamp.isZero());
  expect_axis(lookup.found->value.axis, axis_in_liver(0.0));
}

TEST_F(ToolPosesTest, NoneIfEitherFrameIsMissing) {
  send_tip(1.0);
  EXPECT_NE(poses_.pose(kTool, "liver", ros::Time(1.0)).why_not.find("trocar"), std::string::npos);
  send_trocar(1.0);
  EXPECT_TRUE(poses_.pose(kTool, "liver", ros::Time(1.0)).found);
  const auto late = poses_.pose(kTool, "liver", ros::Time(1.1));
  EXPECT_FALSE(late.found);
  EXPECT_FALSE(late.why_not.empty());
  EXPECT_FALSE(poses_.pose(kTool, "kidney", ros::Time(1.0)).found);
}

TEST_F(ToolPosesTest, NoneIfTheFramesNeverShareATime) {
  send_trocar(1.0);
  send_tip(2.0);
  EXPECT_FALSE(poses_.pose(kTool, "liver", ros::Time(0)).found);
}

TEST_F(ToolPosesTest, PathFollowsTheArc) {
  for (int i = 0; i <= 10; ++i) send(1.0 + 0.01 * i);
  const SampledPath sampled = path(1.0, 1.1, {0.01, 100});
  ASSERT_EQ(sampled.path.size(), 11u);
  EXPECT_EQ(sampled.samples_cut, 0u);
  for (int i = 0; i <= 10; ++i) {
    EXPECT_NEAR(sampled.path[i].fraction, 0.1 * i, 1e-12);
    expect_axis(sampled.path[i].axis, axis_in_liver(1.0 + 0.01 * i), 1e-7);
  }
  EXPECT_EQ(sampled.path.front().fraction, 0.0);
  EXPECT_EQ(sampled.path.back().fraction, 1.0);
}

TEST_F(ToolPosesTest, PosesThatCameAsMessagesAreWaypoints) {
  const double times[] = {1.0, 1.013, 1.0134, 1.02, 1.071, 1.1};
  ToolPoses poses(buffer_, {0.01, 100});
  for (const double time : times) {
    send(time);
    poses.add_sample(kTool.parameters, ros::Time(time));
  }
  poses.add_sample({"other", "trocar", "tip", 0.005}, ros::Time(1.05));
  const SampledPath sampled = poses.path(kTool, "liver", {{axis_in_liver(1.0)}, ros::Time(1.0)},
                                         {{axis_in_liver(1.1)}, ros::Time(1.1)});
  // Even samples in between lie on straight ways, and are left out.
  ASSERT_EQ(sampled.path.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(sampled.path[i].fraction, (times[i] - 1.0) / 0.1, 1e-7);
    expect_axis(sampled.path[i].axis, axis_in_liver(times[i]), 1e-7);
  }
}

TEST_F(ToolPosesTest, PosesBeyondTheMostSamplesAreCounted) {
  ToolPoses poses(buffer_, {1.0, 5});
  for (int i = 0; i <= 100; ++i) {
    send(1.0 + 0.001 * i);
    poses.add_sample(kTool.parameters, ros::Time(1.0 + 0.001 * i));
  }
  const SampledPath sampled = poses.path(kTool, "liver", {{axis_in_liver(1.0)}, ros::Time(1.0)},
                                         {{axis_in_liver(1.1)}, ros::Time(1.1)});
  EXPECT_EQ(sampled.path.size(), 6u);
  EXPECT_EQ(sampled.samples_cut, 95u);
  for (std::size_t i = 1; i < sampled.path.size(); ++i) {
    EXPECT_GT(sampled.path[i].fraction, sampled.path[i - 1].fraction);
  }
}

TEST_F(ToolPosesTest, PosesGoBeforeSamplesInBetween) {
  ToolPoses poses(buffer_, {0.001, 100});
  for (int i = 0; i <= 90; ++i) {
    const double time = 1.0 + 0.00111 * i;  // never at an even sample
    send(time);
    poses.add_sample(kTool.parameters, ros::Time(time));
  }
  const SampledPath sampled = poses.path(kTool, "liver", {{axis_in_liver(1.0)}, ros::Time(1.0)},
                                         {{axis_in_liver(1.0999)}, ros::Time(1.0999)});
  EXPECT_EQ(sampled.path.size(), 91u);
  EXPECT_EQ(sampled.samples_cut, 0u);
}

TEST_F(ToolPosesTest, ASampleOutOfAllBoundsIsLeftOut) {
  for (const double time : {1.0, 1.25, 1.75, 2.0}) send(time);
  send_trocar(1.5);
  set_point(buffer_, "world", "tip", 1.5, {0.0, 1e9, 0.0});
  const SampledPath sampled = path(1.0, 2.0, {0.25, 100});
  ASSERT_EQ(sampled.path.size(), 4u);
  EXPECT_DOUBLE_EQ(sampled.path[1].fraction, 0.25);
  EXPECT_DOUBLE_EQ(sampled.path[2].fraction, 0.75);
}

TEST_F(ToolPosesTest, AToolWhosePosesNeverCameNamesTheTopic) {
  send_trocar(1.0);
  Tool tool = kTool;
  tool.parameters.tip_pose_topic = "/arm/measured_cp";
  EXPECT_NE(poses_.pose(tool, "liver", ros::Time(1.0)).why_not.find("/arm/measured_cp"),
            std::string::npos);
}

TEST_F(ToolPosesTest, CutSamplesAreCountedAndTheWayStaysWhole) {
  for (int i = 0; i <= 100; ++i) send(1.0 + 0.01 * i);
  const SampledPath sampled = path(1.0, 2.0, {0.01, 4});
  ASSERT_EQ(sampled.path.size(), 5u);
  EXPECT_EQ(sampled.samples_cut, 96u);
  for (int i = 0; i <= 4; ++i) {
    EXPECT_DOUBLE_EQ(sampled.path[i].fraction, 0.25 * i);
    expect_axis(sampled.path[i].axis, axis_in_liver(1.0 + 0.25 * i), 1e-7);
  }
}

TEST_F(ToolPosesTest, SamplesThatTfLacksAreLeftOut) {
  for (const double time : {1.5, 1.75, 2.0}) send(time);
  const SampledPath sampled = path(1.0, 2.0, {0.25, 100});
  ASSERT_EQ(sampled.path.size(), 4u);
  EXPECT_DOUBLE_EQ(sampled.path[1].fraction, 0.5);
  expect_axis(sampled.path[1].axis, axis_in_liver(1.5));
  expect_axis(sampled.path[0].axis, axis_in_liver(1.0), 1e-15);
}

TEST_F(ToolPosesTest, PathWithoutTfIsStraight) {
  const SampledPath sampled = path(1.0, 1.05, {0.01, 100});
  ASSERT_EQ(sampled.path.size(), 2u);
  expect_axis(sampled.path[0].axis, axis_in_liver(1.0), 1e-15);
  expect_axis(sampled.path[1].axis, axis_in_liver(1.05), 1e-15);
}

TEST_F(ToolPosesTest, PathWithinOneSampleIsStraight) {
  for (int i = 0; i <= 10; ++i) send(1.0 + 0.001 * i);
  EXPECT_EQ(path(1.0, 1.001, {0.001, 100}).path.size(), 2u);
  EXPECT_EQ(path(1.0, 1.0, {0.001, 100}).path.size(), 2u);
  EXPECT_EQ(path(1.01, 1.0, {0.001, 100}).path.size(), 2u);
  EXPECT_EQ(path(1.0, 1.0015, {0.001, 100}).path.size(), 3u);
}

TEST_F(ToolPosesTest, WaypointsOnAStraightWayAreLeftOut) {
  // TF interpolates between the two that it has: one straight leg, then one more.
  for (const double time : {1.0, 1.04, 1.1}) send(time);
  const SampledPath sampled = path(1.0, 1.1, {0.01, 100});
  ASSERT_EQ(sampled.path.size(), 3u);
  EXPECT_NEAR(sampled.path[1].fraction, 0.4, 1e-9);
  expect_axis(sampled.path[1].axis, axis_in_liver(1.04), 1e-8);
}

TEST_F(ToolPosesTest, SlightBendsAddUp) {
  // Any three samples in a row are straight to the tolerance, the whole arc is not.
  const double duration = 0.001;
  for (int i = 0; i <= 1000; ++i) send(1.0 + 1e-6 * i);
  const SampledPath sampled = path(1.0, 1.0 + duration, {1e-6, 1000});
  ASSERT_GT(sampled.path.size(), 2u);
  for (std::size_t leg = 1; leg < sampled.path.size(); ++leg) {
    const ShaftMotion motion{sampled.path[leg - 1].axis, sampled.path[leg].axis};
    const double middle = 0.5 * (sampled.path[leg - 1].fraction + sampled.path[leg].fraction);
    expect_axis(motion.at(0.5), axis_in_liver(1.0 + duration * middle), 2e-9);
  }
}

TEST_F(ToolPosesTest, TrocarThatMovesByRoundingRests) {
  ShaftAxis from = axis_in_liver(1.0), to = axis_in_liver(1.0);
  from.trocar.x() += 1e-12;
  to.tip.y() += 0.01;
  SampledPath sampled =
      poses_.path(kTool, "liver", {{from}, ros::Time(1)}, {{to}, ros::Time(1.001)});
  EXPECT_EQ(sampled.path.front().axis.trocar, to.trocar);
  EXPECT_EQ(sampled.path.front().axis.tip, from.tip);
  from.trocar.x() += 1e-6;
  sampled = poses_.path(kTool, "liver", {{from}, ros::Time(1)}, {{to}, ros::Time(1.001)});
  EXPECT_EQ(sampled.path.front().axis.trocar, from.trocar);
}

TEST_F(ToolPosesTest, AbsurdStampsAreSurvived) {
  send(1.0);
  const ros::Time last(4294967295u, 999999999u);
  EXPECT_FALSE(poses_.pose(kTool, "liver", last).found);
  const SampledPath sampled = poses_.path(kTool, "liver", {{axis_in_liver(1.0)}, ros::Time(1)},
                                          {{axis_in_liver(2.0)}, last});
  EXPECT_EQ(sampled.path.size(), 2u);
  EXPECT_GT(sampled.samples_cut, 0u);
}
