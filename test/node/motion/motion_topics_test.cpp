#include "node/motion/motion_topics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tool_poses_fixture.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

geometry_msgs::TransformStamped transform(const std::string& child, double time) {
  return transform_of("/world", child, time, Isometry3d(Eigen::Translation3d(time, 0.0, 0.0)));
}

ToolParameters streamed_tool(const std::string& name) {
  return {name, "base", name + "_tip", 0.005, "measured_cp", "base_pose"};
}

class MotionTopicsTest : public testing::Test {
 protected:
  MotionTopicsTest() { ros::Time::setNow(ros::Time(1000.0)); }

  void take(const std::vector<geometry_msgs::TransformStamped>& transforms, bool resting) {
    tf2_msgs::TFMessage message;
    message.transforms = transforms;
    topics_.take_transforms(message, "robot", resting);
  }
  /// The position of the tip in a frame; NaN if the buffer does not have it.
  Vector3d tip(const std::string& frame, double time, const std::string& tool = "left") const {
    const auto found = look_up(buffer_, frame, tool + "_tip", ros::Time(time)).found;
    return found ? Vector3d(found->value.translation())
                 : Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  std::size_t rejected() const { return rejected_.by_reason()["pose"].count; }
  void expect_rejected(const geometry_msgs::PoseStamped& bad, const std::string& word) {
    const std::size_t before = rejected(), arrivals = arrived_.size();
    topics_.take_tip(0, bad);
    EXPECT_EQ(rejected(), before + 1);
    EXPECT_EQ(arrived_.size(), arrivals);
    const std::string message = rejected_.by_reason().at("pose").latest;
    EXPECT_NE(message.find("left_tip"), std::string::npos) << message;
    EXPECT_NE(message.find(word), std::string::npos) << message;
  }

  TransformBuffer buffer_;
  FailureLog rejected_;
  AheadLimit ahead_;
  std::vector<std::size_t> arrived_;
  MotionTopics topics_{{streamed_tool("left"), streamed_tool("right")},
                       buffer_,
                       rejected_,
                       [this](std::size_t tool) { arrived_.push_back(tool); },
                       ahead_};
};

}  // namespace

TEST_F(MotionTopicsTest, WhatTfRefusesIsCountedButNoRepetition) {
  geometry_msgs::TransformStamped broken = transform("tip", 1.0);
  broken.transform.translation.y = std::nan("");
  take({broken, transform("tip", 1.0), transform("tip", 1.0)}, false);
  EXPECT_EQ(rejected_.by_reason()["transform"].count, 1u);
  EXPECT_NE(rejected_.by_reason()["transform"].latest.find("(1, nan, 0)"), std::string::npos)
      << rejected_.by_reason()["transform"].latest;
  take({transform("tip", 100.0), transform("tip", 1.5)}, false);
  EXPECT_EQ(rejected_.by_reason()["transform"].count, 2u) << "1.5 is too old";
  take({broken}, true);
  EXPECT_EQ(rejected_.by_reason()["transform"].count, 3u);
  geometry_msgs::TransformStamped absurd = transform("tip", 1.0);
  absurd.header.stamp = ros::Time(4294967295u, 999999999u);  // tf2 throws.
  take({absurd, transform("trocar", 100.0)}, false);
  EXPECT_EQ(rejected_.by_reason()["transform"].count, 4u);
  EXPECT_TRUE(buffer_.canTransform("world", "trocar", ros::Time(100.0)));
}

// tf2 logs each of them itself.
TEST_F(MotionTopicsTest, ARepeatedStampWithAnotherPoseIsToldByTheNodeAlone) {
  geometry_msgs::TransformStamped other = transform("tip", 1.0);
  other.transform.translation.y = 0.5;
  testing::internal::CaptureStderr();
  take({transform("tip", 1.0), transform("tip", 1.0), other}, false);
  EXPECT_EQ(rejected_.by_reason()["transform"].count, 1u);
  EXPECT_NE(rejected_.by_reason()["transform"].latest.find("'tip': the stamp 1.000000000 came "
                                                           "before, with another pose"),
            std::string::npos)
      << rejected_.by_reason()["transform"].latest;
  for (int i = 0; i < 100; ++i) take({other}, false);
  take({transform("tip", 100.0), transform("tip", 1.5)}, false);
  for (int i = 0; i < 3; ++i) topics_.take_tip(0, pose_of("base", 5.0, {0.1, 0.1 * i, 0.3}));
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(log.find("TF_"), std::string::npos) << log;
  EXPECT_EQ(rejected_.by_reason()["transform"].count, 102u);
  EXPECT_EQ(rejected(), 2u);
}

TEST_F(MotionTopicsTest, PosesPlaceTheTip) {
  topics_.take_tip(0, pose_of("base", 1.0, {0.1, 0.2, 0.3}));
  topics_.take_tip(0, pose_of("/base", 2.0, {0.3, 0.2, 0.1}));
  topics_.take_tip(1, pose_of("base", 2.0, {7.0, 8.0, 9.0}));
  EXPECT_TRUE(tip("base", 1.0).isApprox(Vector3d(0.1, 0.2, 0.3)));
  EXPECT_TRUE(tip("base", 1.5).isApprox(Vector3d(0.2, 0.2, 0.2)));
  EXPECT_TRUE(tip("base", 2.0, "right").isApprox(Vector3d(7.0, 8.0, 9.0)));
  EXPECT_EQ(arrived_, (std::vector<std::size_t>{0, 0, 1}));
  EXPECT_EQ(rejected(), 0u);
}

TEST_F(MotionTopicsTest, TheBaseMayComeFirstOrLastAndRests) {
  topics_.take_base(0, pose_of("world", 1.0, {10.0, 0.0, 0.0}));
  topics_.take_tip(0, pose_of("base", 50.0, {0.1, 0.2, 0.3}));
  EXPECT_TRUE(tip("world", 50.0).isApprox(Vector3d(10.1, 0.2, 0.3)));
  topics_.take_base(0, pose_of("world", 2.0, {20.0, 0.0, 0.0}));
  EXPECT_TRUE(tip("world", 50.0).isApprox(Vector3d(20.1, 0.2, 0.3)));
  EXPECT_EQ(rejected(), 0u);
}

TEST_F(MotionTopicsTest, BadPosesAreRejectedAndTheLastOneStays) {
  const double nan = std::nan("");
  topics_.take_tip(0, pose_of("base", 1.0, {0.1, 0.2, 0.3}));
  expect_rejected(pose_of("base", 2.0, {0.1, nan, 0.3}), "nan");
  expect_rejected(pose_of("base", 2.0, {0.1, std::numeric_limits<double>::infinity(), 0.3}), "inf");
  expect_rejected(pose_of("base", 2.0, {0.1, -1e7, 0.3}), "-1e+07");
  expect_rejected(pose_of("base", ros::Time::now().toSec() + 60.0, {0.1, 0.2, 0.3}), "clock");
  expect_rejected(pose_of("base", 1.0, {0.4, 0.5, 0.6}), "stamp of an earlier one");
  expect_rejected(pose_of("", 2.0, {0.1, 0.2, 0.3}), "frame_id");
  expect_rejected(pose_of(std::string(10'000'000, 'x'), 2.0, {0.1, 0.2, 0.3}), "at most 256 bytes");
  expect_rejected(pose_of("left_tip", 2.0, {0.1, 0.2, 0.3}), "own frame");
  auto turned = pose_of("base", 2.0, {0.1, 0.2, 0.3});
  turned.pose.orientation.w = 0.0;
  expect_rejected(turned, "quaternion");
  turned.pose.orientation.w = nan;
  expect_rejected(turned, "quaternion");
  EXPECT_TRUE(tip("base", 0.0).isApprox(Vector3d(0.1, 0.2, 0.3)));
  EXPECT_EQ(arrived_.size(), 1u);
}

TEST_F(MotionTopicsTest, ToolsMayShareATipAndItsPoses) {
  ToolParameters wide = streamed_tool("left");
  wide.name = "wide";
  MotionTopics topics(
      {streamed_tool("left"), wide}, buffer_, rejected_,
      [this](std::size_t tool) { arrived_.push_back(tool); }, ahead_);
  for (const double time : {1.0, 1.1}) {
    topics.take_tip(0, pose_of("base", time, {time, 0.0, 0.0}));
    topics.take_tip(1, pose_of("base", time, {time, 0.0, 0.0}));
  }
  for (const std::size_t tool : {0, 1})
    topics.take_tip(tool, pose_of("base", 1.05, {1.05, 0.0, 0.0}));
  EXPECT_EQ(arrived_, (std::vector<std::size_t>{0, 1, 0, 1, 0, 1})) << "also with an earlier stamp";
  EXPECT_EQ(rejected(), 0u);
  topics.take_tip(0, pose_of("base", 1.05, {2.0, 0.0, 0.0}));
  topics.take_tip(1, pose_of("base", 1.05, {2.0, 0.0, 0.0}));
  EXPECT_EQ(rejected(), 2u) << "another pose with the same stamp";
}
