#include <gtest/gtest.h>

#include <cmath>

#include "ros/motion/tool_poses.hpp"
#include "tool_poses_fixture.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

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

TEST_F(ToolPosesTest, EveryPoseThatTfWasToldIsAWaypoint) {
  const double times[] = {1.0, 1.013, 1.0134, 1.02, 1.071, 1.1};
  for (const double time : times) send(time);
  set_point(buffer_, "world", "other", 1.05, {1.0, 2.0, 3.0});
  const SampledPath sampled = path(1.0, 1.1, {0.01, 100});
  // The even samples in between lie on straight lines, so they are dropped.
  ASSERT_EQ(sampled.path.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(sampled.path[i].fraction, (times[i] - 1.0) / 0.1, 1e-7);
    expect_axis(sampled.path[i].axis, axis_in_liver(times[i]), 1e-7);
  }
}

TEST_F(ToolPosesTest, FramesNeedNotMoveAtTheSameTimes) {
  for (int i = 0; i <= 20; ++i) send_trocar(1.0 + 0.005 * i);
  for (int i = 0; i <= 7; ++i) send_tip(1.0 + 0.015 * i);
  const SampledPath sampled =
      ToolPoses(buffer_, {1.0, 100}).path(kTool, "liver", known_pose(1.0), known_pose(1.1));
  // The trocar moves on a straight line, so the waypoints are those of the tip's path.
  ASSERT_EQ(sampled.path.size(), 8u);
  for (int i = 0; i <= 6; ++i) EXPECT_NEAR(sampled.path[i].fraction, 0.15 * i, 1e-7);
}

TEST_F(ToolPosesTest, OfTooManyPosesThoseThatMatterMostStay) {
  for (int i = 0; i <= 100; ++i) {
    const double time = 1.0 + 0.001 * i;
    send_trocar(time);
    const double stab = i == 37 ? 0.3 : 0.0, wobble = i % 2 == 0 ? 0.0 : 1e-6;
    set_point(buffer_, "world", "tip", time, trocar(time) - Vector3d(0.0, wobble, 0.1 + stab));
  }
  const SampledPath sampled =
      ToolPoses(buffer_, {1.0, 4}).path(kTool, "liver", known_pose(1.0), known_pose(1.1));
  ASSERT_EQ(sampled.path.size(), 5u);
  for (int i = 1; i <= 3; ++i) EXPECT_NEAR(sampled.path[i].fraction, 0.35 + 0.01 * i, 1e-7);
  EXPECT_EQ(sampled.samples_cut, 96u);
  EXPECT_GE(sampled.deviation_cut, 0.5e-6);
  EXPECT_LE(sampled.deviation_cut, 1e-6 + 1e-12);
}

TEST_F(ToolPosesTest, OfVeryManyPosesThoseReadAreSpreadEvenly) {
  for (int i = 0; i <= 3000; ++i) send(1.0 + 0.001 * i);
  const SampledPath sampled = path(1.0, 4.0, {1.0, 4});
  ASSERT_EQ(sampled.path.size(), 5u);
  EXPECT_EQ(sampled.samples_cut, 2999u - 3u);
  EXPECT_TRUE(std::isinf(sampled.deviation_cut)) << "nobody knows";
  for (int leg = 1; leg <= 4; ++leg) {
    EXPECT_LT(sampled.path[leg].fraction - sampled.path[leg - 1].fraction, 0.5);
  }
}

TEST_F(ToolPosesTest, ASampleOutOfAllBoundsIsLeftOut) {
  for (const double time : {1.0, 1.25, 1.75, 2.0}) send(time);
  send_trocar(1.5);
  set_point(buffer_, "world", "tip", 1.5, {0.0, 1e9, 0.0});
  const SampledPath sampled = path(1.0, 2.0, {0.25, 100});
  EXPECT_NE(sampled.unknown.find("1.5"), std::string::npos) << sampled.unknown;
  ASSERT_EQ(sampled.path.size(), 4u);
  EXPECT_DOUBLE_EQ(sampled.path[1].fraction, 0.25);
  EXPECT_DOUBLE_EQ(sampled.path[2].fraction, 0.75);
}

TEST_F(ToolPosesTest, CutSamplesAreCountedAndTheWayStaysWhole) {
  for (int i = 0; i <= 100; ++i) send(1.0 + 0.01 * i);
  const SampledPath sampled = path(1.0, 2.0, {0.01, 4});
  ASSERT_EQ(sampled.path.size(), 5u);
  EXPECT_EQ(sampled.samples_cut, 96u);
  for (int leg = 1; leg <= 4; ++leg) {
    const ToolWaypoint &a = sampled.path[leg - 1], &b = sampled.path[leg];
    expect_axis(b.axis, axis_in_liver(1.0 + b.fraction), 1e-7);
    for (const double time : {0.25, 0.5, 0.75}) {
      expect_axis(ShaftMotion{a.axis, b.axis}.at(time),
                  axis_in_liver(1.0 + a.fraction + time * (b.fraction - a.fraction)),
                  sampled.deviation_cut + 2e-5);
    }
  }
  EXPECT_LT(sampled.deviation_cut, 0.01);
}

TEST_F(ToolPosesTest, StraightSamplesInBetweenAreCounted) {
  for (const double time : {1.0, 2.0}) send(time);
  const SampledPath sampled = path(1.0, 2.0, {0.01, 4});
  EXPECT_EQ(sampled.path.size(), 2u);
  EXPECT_EQ(sampled.samples_cut, 96u);
  EXPECT_EQ(sampled.deviation_cut, 0.0);
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
  // TF interpolates between its three transforms, so the path consists of two straight legs.
  for (const double time : {1.0, 1.04, 1.1}) send(time);
  const SampledPath sampled = path(1.0, 1.1, {0.01, 100});
  ASSERT_EQ(sampled.path.size(), 3u);
  EXPECT_NEAR(sampled.path[1].fraction, 0.4, 1e-9);
  expect_axis(sampled.path[1].axis, axis_in_liver(1.04), 1e-8);
}

TEST_F(ToolPosesTest, SlightBendsAddUp) {
  // Any three consecutive samples are straight within the tolerance, but the whole arc is not.
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
