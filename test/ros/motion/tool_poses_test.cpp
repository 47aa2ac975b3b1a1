#include "ros/motion/tool_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/tool/leg_motion.hpp"
#include "test/ros/tools/hand_made_tools.hpp"
#include "tool_poses_fixture.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;

TEST_F(ToolPosesTest, AxisInTheOrgansFrame) {
  send(1.0);
  send(2.0);
  const auto lookup = poses_.pose(kTool, "liver", ros::Time(2.0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  expect_axis(lookup.found->value.axis, axis_in_liver(2.0));
  EXPECT_EQ(lookup.found->stamp, ros::Time(2.0));
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

TEST_F(ToolPosesTest, AToolWhosePosesNeverCameNamesTheTopic) {
  send_trocar(1.0);
  Tool tool = kTool;
  tool.parameters.tip_pose_topic = "/arm/measured_cp";
  EXPECT_NE(poses_.pose(tool, "liver", ros::Time(1.0)).why_not.find("/arm/measured_cp"),
            std::string::npos);
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

TEST_F(ToolPosesTest, PathWithinOneSampleIsStraight) {
  for (int i = 0; i <= 10; ++i) send(1.0 + 0.001 * i);
  EXPECT_EQ(path(1.0, 1.001, {0.001, 100}).path.size(), 2u);
  EXPECT_EQ(path(1.0, 1.0, {0.001, 100}).path.size(), 2u);
  EXPECT_EQ(path(1.01, 1.0, {0.001, 100}).path.size(), 2u);
  EXPECT_EQ(path(1.0, 1.0015, {0.001, 100}).path.size(), 3u);
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

namespace {

Isometry3d turn(double angle, const Vector3d& axis) {
  return Isometry3d(Eigen::AngleAxisd(angle, axis.normalized()));
}

/// A liver that rests in the world, a wrist that turns, and a jaw that turns on it.
class LinkPosesTest : public testing::Test {
 protected:
  LinkPosesTest() { set_transform(buffer_, "world", "liver", 0.0, kWorldLiver, true); }

  static Isometry3d wrist(double time) {
    return Eigen::Translation3d(0.1, 0.2, 0.5) * turn(std::sin(time), {0.2, 1.0, -0.3});
  }
  static Isometry3d jaw_on_wrist(double time) {
    return Eigen::Translation3d(0.0, 0.01, 0.05) * turn(2.0 * time, {1.0, 0.1, 0.2});
  }
  static Isometry3d in_liver(const Isometry3d& T_world_link) {
    return kWorldLiver.inverse() * T_world_link;
  }
  static ToolPose pose_at(double time) {
    return {{Vector3d::Zero(), Vector3d::Zero()},
            {in_liver(wrist(time)), in_liver(wrist(time) * jaw_on_wrist(time))}};
  }

  void send_wrist(double time) { set_transform(buffer_, "world", "arm/wrist", time, wrist(time)); }
  void send_jaw(double time) {
    set_transform(buffer_, "arm/wrist", "arm/jaw", time, jaw_on_wrist(time));
  }
  void send(double time) {
    send_wrist(time);
    send_jaw(time);
  }
  static void expect_links(const std::vector<Isometry3d>& links,
                           const std::vector<Isometry3d>& expected, double tolerance = 1e-9) {
    ASSERT_EQ(links.size(), expected.size());
    for (std::size_t i = 0; i < links.size(); ++i) {
      EXPECT_LT((links[i].matrix() - expected[i].matrix()).norm(), tolerance) << "link " << i;
    }
  }

  const Tool grasper_ = grasper();
  TransformBuffer buffer_;
  ToolPoses poses_{buffer_, {0.001, 100}};
};

}  // namespace

TEST_F(LinkPosesTest, ShaftAndLinks) {
  const Tool tool = with_links(shaft_tool("hook", 0.005));
  const Vector3d trocar(0.1, -0.2, 0.7), tip(0.2, 0.1, 0.3);
  set_point(buffer_, "world", "hook_trocar", 0.0, trocar, true);
  set_point(buffer_, "world", "hook_tip", 1.0, tip);
  EXPECT_FALSE(poses_.pose(tool, "liver", ros::Time(1.0)).found);
  send(1.0);
  const auto lookup = poses_.pose(tool, "liver", ros::Time(1.0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  EXPECT_LT((lookup.found->value.axis.trocar - kWorldLiver.inverse() * trocar).norm(), 1e-9);
  EXPECT_LT((lookup.found->value.axis.tip - kWorldLiver.inverse() * tip).norm(), 1e-9);
  expect_links(lookup.found->value.links, pose_at(1.0).links);
}

TEST_F(LinkPosesTest, LatestIsTheLatestThatAllFramesHave) {
  Tool tool = with_links(shaft_tool("hook", 0.005));
  set_point(buffer_, "world", "hook_trocar", 0.0, {0.1, -0.2, 0.7}, true);
  for (const double time : {1.0, 1.25, 1.5, 2.0, 2.5}) {
    set_point(buffer_, "world", "hook_tip", time, {0.2, 0.1, 0.1 * time});
    if (time <= 2.0) send_wrist(time);
    if (time <= 1.5) send_jaw(time);
  }
  const auto lookup = poses_.pose(tool, "liver", ros::Time(0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  EXPECT_EQ(lookup.found->stamp, ros::Time(1.5));
  expect_links(lookup.found->value.links, pose_at(1.5).links);
  const Vector3d tip = kWorldLiver.inverse() * Vector3d(0.2, 0.1, 0.15);
  EXPECT_LT((lookup.found->value.axis.tip - tip).norm(), 1e-9);
}

TEST_F(LinkPosesTest, RestingLinksTakeTheTimeOfTheOthers) {
  set_transform(buffer_, "world", "arm/wrist", 0.0, wrist(1.5), true);
  send_jaw(1.5);
  const auto lookup = poses_.pose(grasper_, "liver", ros::Time(0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  EXPECT_EQ(lookup.found->stamp, ros::Time(1.5));
  expect_links(lookup.found->value.links, pose_at(1.5).links);
}

TEST_F(LinkPosesTest, AMissingFrameIsNamedWithItsLinkAndItsJoint) {
  std::string why = poses_.pose(grasper_, "liver", ros::Time(1.0)).why_not;
  for (const char* word : {"link 'wrist'", "tool 'grasper'", "'arm/wrist' is unknown"}) {
    EXPECT_NE(why.find(word), std::string::npos) << "'" << word << "' in: " << why;
  }
  EXPECT_EQ(why.find("joint"), std::string::npos) << why;
  send_wrist(1.0);
  why = poses_.pose(grasper_, "liver", ros::Time(1.0)).why_not;
  for (const char* word :
       {"link 'jaw'", "tool 'grasper'", "arm/jaw", "is joint 'jaw_joint' published?"}) {
    EXPECT_NE(why.find(word), std::string::npos) << "'" << word << "' in: " << why;
  }
}

TEST_F(LinkPosesTest, ALateJointIsPublished) {
  send(1.0);
  send_wrist(1.1);
  const std::string why = poses_.pose(grasper_, "liver", ros::Time(1.007)).why_not;
  EXPECT_EQ(why,
            "link 'jaw' of tool 'grasper': TF from 'arm/jaw' to 'liver' is 7 ms behind the "
            "stamp 1.007000000");
}

TEST_F(LinkPosesTest, PathFollowsTheJoints) {
  // The poses at the samples are exact, because TF has each joint at these times.
  for (int i = 0; i <= 100; ++i) send(1.0 + 0.001 * i);
  const SampledPath sampled = poses_.path(grasper_, "liver", {pose_at(1.0), ros::Time(1.0)},
                                          {pose_at(1.1), ros::Time(1.1)});
  EXPECT_EQ(sampled.samples_cut, 0u);
  EXPECT_GT(sampled.path.size(), 2u);
  EXPECT_LT(sampled.path.size(), 30u);
  for (std::size_t leg = 1; leg < sampled.path.size(); ++leg) {
    const ToolWaypoint &from = sampled.path[leg - 1], &to = sampled.path[leg];
    expect_links(to.links, pose_at(1.0 + 0.1 * to.fraction).links, 1e-7);
    const double middle = 1.0 + 0.05 * (from.fraction + to.fraction);
    for (std::size_t i = 0; i < 2; ++i) {
      const Isometry3d found = RigidMotion(from.links[i], to.links[i]).at(0.5);
      const Isometry3d right = pose_at(middle).links[i];
      EXPECT_LT((found.translation() - right.translation()).norm(), 1.1e-6);
    }
  }
}

TEST_F(LinkPosesTest, ASampleOutOfAllBoundsIsLeftOut) {
  for (const double time : {1.0, 1.25, 1.75, 2.0}) send(time);
  send_wrist(1.5);
  set_point(buffer_, "arm/wrist", "arm/jaw", 1.5, {0.0, 1e9, 0.0});
  const SampledPath sampled =
      ToolPoses(buffer_, {0.25, 100})
          .path(grasper_, "liver", {pose_at(1.0), ros::Time(1)}, {pose_at(2.0), ros::Time(2)});
  ASSERT_EQ(sampled.path.size(), 4u);
  EXPECT_DOUBLE_EQ(sampled.path[1].fraction, 0.25);
  EXPECT_DOUBLE_EQ(sampled.path[2].fraction, 0.75);
}

/// The grasper, whose links have a tip in a frame of its own.
class TipOfLinksTest : public LinkPosesTest {
 protected:
  TipOfLinksTest() { tool_.parameters.tip_frame = "jaw_tip"; }

  static Vector3d tip(double time) { return {0.1 + 0.2 * time, 0.3, -0.1 * time}; }
  void send_tip(double time) { set_point(buffer_, "world", "jaw_tip", time, tip(time)); }

  Tool tool_ = grasper();
};

TEST_F(TipOfLinksTest, IsInTheOrgansFrame) {
  send(1.0);
  send_tip(1.0);
  const auto lookup = poses_.pose(tool_, "liver", ros::Time(1.0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  ASSERT_TRUE(lookup.found->value.tip);
  EXPECT_LT((*lookup.found->value.tip - kWorldLiver.inverse() * tip(1.0)).norm(), 1e-9);
  EXPECT_TRUE(poses_.has_pose(tool_, "liver", ros::Time(1.0)));
  EXPECT_FALSE(poses_.pose(grasper_, "liver", ros::Time(1.0)).found->value.tip);
}

TEST_F(TipOfLinksTest, IsNeededAndNamedIfItIsMissing) {
  send(1.0);
  const auto lookup = poses_.pose(tool_, "liver", ros::Time(1.0));
  EXPECT_FALSE(lookup.found);
  EXPECT_EQ(lookup.why_not, "tip of tool 'grasper': frame 'jaw_tip' is unknown to TF");
  EXPECT_FALSE(poses_.has_pose(tool_, "liver", ros::Time(1.0)));
  EXPECT_TRUE(poses_.has_pose(grasper_, "liver", ros::Time(1.0)));
}

TEST_F(TipOfLinksTest, TakesPartInTheLatestTime) {
  for (const double time : {1.0, 1.5, 2.0}) send(time);
  for (const double time : {1.0, 1.5}) send_tip(time);
  const auto lookup = poses_.pose(tool_, "liver", ros::Time(0));
  ASSERT_TRUE(lookup.found) << lookup.why_not;
  EXPECT_EQ(lookup.found->stamp, ros::Time(1.5));
  EXPECT_LT((*lookup.found->value.tip - kWorldLiver.inverse() * tip(1.5)).norm(), 1e-9);
}
