// How load_tool finds the description of a robot on the parameter server.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include "ros/tools/tool.hpp"
#include "test/ros/tools/tool_files.hpp"

namespace organ_collision {
namespace {

/// A robot with one link, a ball.
std::string ball(const std::string& radius) {
  return "<robot name='ball'><link name='ball'><collision><geometry><sphere radius='" + radius +
         "'/></geometry></collision></link></robot>";
}

Tool load(const std::string& robot_description, const std::string& node) {
  ToolParameters parameters;
  parameters.name = "probe";
  parameters.links = {"ball"};
  parameters.robot_description = robot_description;
  return load_tools({parameters}, ros::NodeHandle(node)).front();
}

/// Radius [m] of the ball in the description that is found.
double radius(const std::string& robot_description, const std::string& node) {
  const Tool tool = load(robot_description, node);
  EXPECT_EQ(tool.fault, "");
  return tool.fault.empty() ? tool.links.at(0).parts.at(0).radius : 0.0;
}

class RobotDescription : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    ros::param::set("/robot_description", ball("1"));
    ros::param::set("/left/robot_description", ball("2"));
    ros::param::set("/own/organ_collision/robot_description", ball("3"));
    ros::param::set("/number", 4);
  }
};

TEST_F(RobotDescription, IsTheNearestFromTheNodeUpwards) {
  EXPECT_EQ(radius("robot_description", "/organ_collision"), 1.0);
  EXPECT_EQ(radius("robot_description", "/right/organ_collision"), 1.0);
  EXPECT_EQ(radius("robot_description", "/left/organ_collision"), 2.0);
  EXPECT_EQ(radius("robot_description", "/own/organ_collision"), 3.0);
}

TEST_F(RobotDescription, MayBeNamedAbsolutely) {
  EXPECT_EQ(radius("/left/robot_description", "/organ_collision"), 2.0);
  EXPECT_EQ(radius("left/robot_description", "/organ_collision"), 2.0);
}

TEST_F(RobotDescription, FaultsNameTheParameter) {
  expect_words(load("robot", "/left/organ_collision").fault,
               {"probe: parameter 'robot'", "neither in /left/organ_collision nor"});
  expect_words(load("left/robot", "/organ_collision").fault,
               {"probe: parameter 'left/robot'", "neither in /organ_collision nor"});
  expect_words(load("number", "/organ_collision").fault, {"probe: parameter 'number'", "no text"});
}

}  // namespace
}  // namespace organ_collision
