#include "ros/motion/tool_poses.hpp"

#include <gtest/gtest.h>

#include "tool_poses_fixture.hpp"

using namespace organ_collision;

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

TEST_F(ToolPosesTest, AToolWhosePosesNeverCameNamesTheTopic) {
  send_trocar(1.0);
  Tool tool = kTool;
  tool.parameters.tip_pose_topic = "/arm/measured_cp";
  EXPECT_NE(poses_.pose(tool, "liver", ros::Time(1.0)).why_not.find("/arm/measured_cp"),
            std::string::npos);
}
