#include "organ_collision/ros/tool_loader.hpp"

#include <gtest/gtest.h>

#include "organ_collision/ros/resource.hpp"
#include "tool_files.hpp"

using namespace organ_collision;

namespace {

ToolParameters gripper(const std::vector<std::string>& links) {
  ToolParameters parameters;
  parameters.name = "PSM1";
  parameters.links = links;
  parameters.robot_description = "robot_description";
  return parameters;
}

/// A parameter server that holds only the gripper.
std::string find_text(const std::string& parameter) {
  if (parameter != "robot_description") throw ToolError("is not set");
  return read_resource(tool_file("gripper.urdf"));
}

void expect_fault(const ToolParameters& parameters, const std::vector<std::string>& words) {
  const Tool tool = load_tool(parameters, find_text);
  EXPECT_EQ(tool.fault.rfind("PSM1: ", 0), 0u) << tool.fault;
  expect_words(tool.fault, words);
  EXPECT_TRUE(tool.links.empty());
  EXPECT_TRUE(tool.joints.empty());
  EXPECT_EQ(tool.parameters.links, parameters.links);
}

}  // namespace

TEST(ToolLoader, LinksInTheOrderOfTheParameters) {
  const Tool tool = load_tool(gripper({"other_jaw", "wrist", "jaw"}), find_text);
  EXPECT_EQ(tool.fault, "");
  EXPECT_EQ(tool.parameters.name, "PSM1");
  ASSERT_EQ(tool.links.size(), 3u);
  EXPECT_EQ(tool.links[0].name, "other_jaw");
  EXPECT_EQ(tool.links[1].name, "wrist");
  EXPECT_EQ(tool.links[2].name, "jaw");
  EXPECT_EQ(tool.joints, (std::vector<std::string>{"other_jaw_joint", "", "jaw_joint"}));
}

TEST(ToolLoader, UrdfOfItsOwn) {
  ToolParameters parameters = gripper({"jaw"});
  parameters.robot_description = "";
  parameters.urdf = tool_file("gripper.urdf");
  const Tool tool = load_tool(parameters, find_text);
  EXPECT_EQ(tool.fault, "");
  EXPECT_EQ(tool.links.size(), 1u);
}

TEST(ToolLoader, ShaftsNeedNoUrdf) {
  const Tool tool = load_tool({"hook", "hook_trocar", "hook_tip", 0.01},
                              [](const std::string&) -> std::string { throw ToolError("asked"); });
  EXPECT_EQ(tool.fault, "");
  EXPECT_TRUE(tool.links.empty());
  EXPECT_EQ(tool.parameters.radius, 0.01);
}

TEST(ToolLoader, FaultsBeginWithTheToolAndThrowNothing) {
  expect_fault(gripper({"jaw", "jaws"}), {"'robot_description'", "'jaws'", "nearest is 'jaw'"});

  ToolParameters unset = gripper({"jaw"});
  unset.robot_description = "/left/robot_description";
  expect_fault(unset, {"'/left/robot_description'", "is not set"});

  ToolParameters no_file = gripper({"jaw"});
  no_file.urdf = "gripper.urdf";
  expect_fault(no_file, {"'gripper.urdf'", "absolute path"});

  ToolParameters no_urdf = gripper({"jaw"});
  no_urdf.urdf = tool_file("notes.txt");
  expect_fault(no_urdf, {"notes.txt", "no legal URDF"});
}
