#include "ros/tools/tool.hpp"

#include <gtest/gtest.h>

#include "ros/tools/link_description.hpp"
#include "tool_files.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

ToolParameters gripper(const std::vector<std::string>& links) {
  ToolParameters parameters;
  parameters.name = "PSM1";
  parameters.links = links;
  parameters.robot_description = "robot_description";
  return parameters;
}

/// Stands for a parameter server with a single parameter, the gripper.
std::string find_text(const std::string& parameter) {
  if (parameter != "robot_description") throw ToolError("is not set");
  return tool_text("gripper.urdf");
}

/// The support value of a part along an axis, with its radius.
double reach(const LinkPart& part, const Vector3d& direction) {
  return part.project_onto(direction).high + part.radius;
}

/// The box around a part, aligned with the link's axes.
void expect_extent(const LinkPart& part, const Vector3d& lowest, const Vector3d& highest) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(reach(part, Vector3d::Unit(axis)), highest[axis], 2e-8) << axis;
    EXPECT_NEAR(-reach(part, -Vector3d::Unit(axis)), lowest[axis], 2e-8) << axis;
  }
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

TEST(ToolLoader, ShapesWhereTheirOriginsAre) {
  const Tool tool = load_tool(gripper({"shaft", "wrist", "jaw", "other_jaw"}), find_text);
  ASSERT_EQ(tool.links.size(), 4u) << tool.fault;
  const std::vector<LinkPart>& shaft = tool.links[0].parts;
  ASSERT_EQ(shaft.size(), 2u);
  EXPECT_NEAR(shaft[0].core.rim.col(0).norm(), 0.004, 1e-15);
  expect_extent(shaft[0], {-0.14, -0.024, 0.096}, {0.16, -0.016, 0.104});
  EXPECT_EQ(shaft[1].radius, 0.005);
  expect_extent(shaft[1], {0.155, -0.025, 0.095}, {0.165, -0.015, 0.105});
  expect_extent(tool.links[1].parts.at(0), {0.48, 0.24, -0.155}, {0.52, 0.26, -0.095});
  expect_extent(tool.links[2].parts.at(0), {0.092, 0.201, 0.306}, {0.098, 0.209, 0.32});
  expect_extent(tool.links[3].parts.at(0), {0.001, -0.008, 0.003}, {0.009, -0.002, 0.01});
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

TEST(ToolLoader, FilesThatCrashOrHangTheirParsersAreFaults) {
  for (const std::string name : {"crashing.obj", "crashing.dae", "cut_off.ply"}) {
    const Tool tool = load_tool(gripper({"tip"}), [&](const std::string&) {
      return "<robot name='r'><link name='tip'><collision><geometry><mesh filename='" +
             tool_file(name) + "'/></geometry></collision></link></robot>";
    });
    expect_words(tool.fault, {"PSM1: parameter 'robot_description': link 'tip'", tool_file(name)});
    EXPECT_TRUE(tool.links.empty());
  }
#ifndef __SANITIZE_THREAD__  // Its printf does not crash, so the file is read.
  ToolParameters parameters = gripper({"tip"});
  parameters.urdf = tool_file("crashing.urdf");
  expect_fault(parameters, {"crashing.urdf'"});
#endif
}
