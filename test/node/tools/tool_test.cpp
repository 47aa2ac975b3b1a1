#include "node/tools/tool.hpp"

#include <gtest/gtest.h>

#include <boost/algorithm/string/replace.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

#include "common/messages/robot_reply.hpp"
#include "hand_made_tools.hpp"
#include "tool_files.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::vector<double> kCorners = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/// A shape at (0.1, 0.2, 0.3), turned by a right angle about z.
RobotShape shape(std::uint8_t kind, double x, double y = 0.0, double z = 0.0) {
  RobotShape shape;
  shape.kind = kind;
  shape.pose = {{0.1, 0.2, 0.3, 0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)}};
  shape.size = {{x, y, z}};
  return shape;
}

RobotShape mesh(const std::vector<double>& vertices, const std::vector<std::uint32_t>& triangles) {
  RobotShape mesh = shape(RobotShape::MESH, 0.0);
  mesh.file = "tip.stl";
  mesh.vertices = vertices;
  mesh.triangles = triangles;
  return mesh;
}

Link link_of(const std::vector<RobotShape>& shapes) {
  RobotLink description;
  description.joint = "wrist";
  description.shapes = shapes;
  return build_link("tip", description);
}

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

const KeptTools kNone = {std::nullopt};
const KeptTools kFirst = {0};

}  // namespace

TEST(LinkBuilder, IllegalValuesAreNamed) {
  const double nan = std::nan("");
  std::vector<std::pair<RobotShape, std::vector<std::string>>> rows = {
      {shape(RobotShape::SPHERE, 0.0), {"link 'tip'", "sphere's radius is 0", "more than 0"}},
      {shape(RobotShape::SPHERE, 2e6), {"2e+06", "at most 1e+06 m"}},
      {shape(RobotShape::SPHERE, nan), {"sphere's radius is nan"}},
      {shape(RobotShape::CYLINDER, -0.01, 1.0), {"cylinder's radius is -0.01", "more than 0"}},
      {shape(RobotShape::CYLINDER, 0.01, 0.0), {"cylinder's length is 0"}},
      {shape(RobotShape::BOX, 1.0, -2.0, 3.0), {"box's side is -2", "more than 0"}},
      {mesh(kCorners, {}), {"mesh 'tip.stl'", "no triangle"}},
      {mesh(kCorners, {0, 1, 3}), {"vertex 3 of 3"}},
      {mesh({2e6, 0, 0}, {0, 0, 0}), {"mesh 'tip.stl'", "vertex 0", "within 1e+06 m"}}};
  for (const std::uint8_t kind : {RobotShape::SPHERE, RobotShape::CYLINDER, RobotShape::BOX}) {
    for (const double bad : {-1e7, kInfinity, nan}) {
      rows.push_back({shape(kind, 1, 1, 1), {"link 'tip'", "origin", "finite and within 1e+06 m"}});
      rows.back().first.pose[1] = bad;
    }
    for (const double bad : {2.0, 0.0, kInfinity, nan}) {
      rows.push_back({shape(kind, 1, 1, 1), {"orientation", "unit quaternion"}});
      rows.back().first.pose[6] = bad;
    }
  }
  for (const auto& [shape, words] : rows) {
    expect_words(tool_error([&, &shape = shape] { link_of({shape}); }), words);
  }
  expect_words(tool_error([] { link_of({}); }), {"link 'tip'", "no collision or visual geometry"});
}

TEST(ToolLoader, ShapesWhereTheirOriginsAre) {
  const Tool tool = load_tool(gripper({"shaft", "wrist", "jaw", "other_jaw"}), find_text);
  ASSERT_EQ(tool.links.size(), 4u) << tool.fault;
  EXPECT_EQ(tool.parameters.name, "PSM1");
  EXPECT_EQ(tool.links[3].name, "other_jaw");
  EXPECT_EQ(tool.joints,
            (std::vector<std::string>{"insertion", "", "jaw_joint", "other_jaw_joint"}));
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

TEST(ToolChanges, EachParameterCounts) {
  const Tool before = with_links(shaft_tool("hook", 0.01));
  EXPECT_EQ(compare_tools({before}, {before}).kept, kFirst);
  const std::vector<std::function<void(Tool&)>> edits = {
      [](Tool& tool) { tool.parameters.trocar_frame += "2"; },
      [](Tool& tool) { tool.parameters.tip_frame += "2"; },
      [](Tool& tool) { tool.parameters.radius *= 1.001; },
      [](Tool& tool) { tool.parameters.tip_pose_topic = "measured_cp"; },
      [](Tool& tool) { tool.parameters.base_pose_topic = "base"; },
      [](Tool& tool) { tool.parameters.links.pop_back(); },
      [](Tool& tool) { tool.parameters.jaws[1] = {"jaw"}; },
      [](Tool& tool) { tool.parameters.robot_description = "robot"; },
      [](Tool& tool) { tool.parameters.urdf = "robot.urdf"; },
      [](Tool& tool) { tool.parameters.tf_prefix = "leg"; },
      [](Tool& tool) { tool.parameters.margin = 0.01; },
      [](Tool& tool) { tool.parameters.max_near = 1; },
      [](Tool& tool) { tool.fault = "no file"; }};
  for (std::size_t i = 0; i < edits.size(); ++i) {
    Tool after = before;
    edits[i](after);
    EXPECT_EQ(compare_tools({before}, {after}).kept, kNone) << i;
  }
}

TEST(ToolChanges, WhatTheFilesSayCounts) {
  const std::string mesh = testing::TempDir() + "changing.stl";
  std::string urdf = tool_text("gripper.urdf"), stl = tool_text("jaw_ascii.stl");
  boost::replace_all(urdf, tool_file("jaw_ascii.stl"), mesh);
  const auto loaded = [&] {
    std::ofstream(mesh) << stl;
    const Tool tool =
        load_tool(gripper({"wrist", "jaw", "other_jaw"}), [&](const std::string&) { return urdf; });
    EXPECT_EQ(tool.fault, "");
    return tool;
  };
  const Tool before = loaded();
  EXPECT_EQ(compare_tools({before}, {loaded()}).kept, kFirst) << "it is read again";
  boost::replace_all(urdf, "0.02 0.04 0.06", "0.02 0.04 0.061");
  const Tool other_box = loaded();
  EXPECT_EQ(compare_tools({before}, {other_box}).kept, kNone);
  boost::replace_all(urdf, "\"jaw_joint\"", "\"hinge\"");
  const Tool other_joint = loaded();
  EXPECT_EQ(compare_tools({other_box}, {other_joint}).kept, kNone);
  boost::replace_all(stl, "vertex 1 2 3\n", "vertex 1 2 3.1\n");
  EXPECT_EQ(compare_tools({other_joint}, {loaded()}).kept, kNone);
}
