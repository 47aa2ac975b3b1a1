#include "ros/tools/tool.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "hand_made_tools.hpp"
#include "ros/tools/robot_reply.hpp"
#include "tool_files.hpp"

using namespace organ_collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const ShapePose kPose{{0.1, 0.2, 0.3}, {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}};
const std::vector<Vector3d> kCorners = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};

ShapeDescription sphere(const ShapePose& pose, double radius) {
  return {ShapeKind::kSphere, pose, {radius, 0.0, 0.0}};
}

ShapeDescription cylinder(const ShapePose& pose, double radius, double length) {
  return {ShapeKind::kCylinder, pose, {radius, length, 0.0}};
}

ShapeDescription box(const ShapePose& pose, const Vector3d& size) {
  return {ShapeKind::kBox, pose, size};
}

ShapeDescription mesh(std::vector<Vector3d> vertices, std::vector<FaceIndices> triangles) {
  return {ShapeKind::kMesh, {}, {0, 0, 0}, {"tip.stl", std::move(vertices), std::move(triangles)}};
}

std::string refusal(const ShapeDescription& shape) {
  return tool_error([&] { build_link("tip", {"wrist", {shape}}); });
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

Tool loaded(const std::string& file, const std::vector<std::string>& links) {
  ToolParameters parameters;
  parameters.name = "arm";
  parameters.links = links;
  parameters.urdf = tool_file(file);
  return load_tool(parameters, [](const std::string&) { return std::string(); });
}

}  // namespace

TEST(LinkBuilder, ShapesInTheirOrderAndWhereTheyAre) {
  const Link link = build_link("tip", {"wrist",
                                       {sphere(kPose, 0.5), cylinder(kPose, 0.1, 2.0),
                                        box(kPose, {1.0, 2.0, 3.0}), mesh(kCorners, {{0, 1, 2}})}});
  EXPECT_EQ(link.name, "tip");
  ASSERT_EQ(link.parts.size(), 4u);
  EXPECT_EQ(link.parts[0].radius, 0.5);
  EXPECT_NEAR(link.parts[0].project_onto(Vector3d::UnitX()).high, 0.1, 1e-15);
  EXPECT_NEAR(link.parts[1].project_onto(Vector3d::UnitZ()).high, 1.3, 1e-15);
  EXPECT_NEAR(link.parts[2].project_onto(Vector3d::UnitX()).high, 1.1,
              1e-15);  // Half of the side along y.
  EXPECT_EQ(link.parts[3].project_onto(Vector3d::UnitX()).high, 1.0);
}

TEST(LinkBuilder, IllegalValuesAreNamed) {
  const double nan = std::nan("");
  std::vector<std::pair<ShapeDescription, std::vector<std::string>>> rows = {
      {sphere(kPose, 0.0), {"link 'tip'", "sphere's radius is 0", "more than 0"}},
      {sphere(kPose, 2e6), {"2e+06", "at most 1e+06 m"}},
      {sphere(kPose, nan), {"sphere's radius is nan"}},
      {cylinder(kPose, -0.01, 1.0), {"cylinder's radius is -0.01", "more than 0"}},
      {cylinder(kPose, 0.01, 0.0), {"cylinder's length is 0"}},
      {box(kPose, {1.0, -2.0, 3.0}), {"box's side is -2", "more than 0"}},
      {mesh(kCorners, {}), {"mesh 'tip.stl'", "no triangle"}},
      {mesh(kCorners, {{0, 1, 3}}), {"vertex 3 of 3"}},
      {mesh({Vector3d(2e6, 0, 0)}, {{0, 0, 0}}), {"mesh 'tip.stl'", "vertex 0", "within 1e+06 m"}}};
  for (const double bad : {-1e7, kInfinity, nan}) {
    rows.push_back({sphere({{0.0, bad, 0.0}, kPose.orientation}, 1.0),
                    {"link 'tip'", "origin", "finite and within 1e+06 m"}});
  }
  for (const double bad : {2.0, 0.0, kInfinity, nan}) {
    const ShapePose pose{kPose.position, Quaterniond(bad, 0.0, 0.0, 0.0)};
    rows.push_back({box(pose, Vector3d::Ones()), {"orientation", "unit quaternion"}});
    rows.push_back({sphere(pose, 1.0), {"orientation"}});
    rows.push_back({cylinder(pose, 1.0, 1.0), {"orientation"}});
  }
  for (const auto& [shape, words] : rows) expect_words(refusal(shape), words);
  expect_words(tool_error([] { build_link("mount", {}); }),
               {"link 'mount'", "no collision or visual geometry"});
}

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

TEST(ToolChanges, ToolsAreFoundByNameInAnyOrder) {
  const std::vector<Tool> before = {shaft_tool("hook", 0.01), grasper(), shaft_tool("saw", 0.02)};
  const std::vector<Tool> after = {shaft_tool("needle", 0.01), shaft_tool("saw", 0.03), grasper()};
  const ToolChanges changes = compare_tools(before, after);
  EXPECT_EQ(changes.kept, (KeptTools{std::nullopt, std::nullopt, 1}));
  EXPECT_EQ(changes.summary,
            "unchanged: 'grasper'; changed: 'saw'; new: 'needle'; removed: 'hook'");
}

TEST(ToolChanges, ListsMayBeEmpty) {
  EXPECT_EQ(compare_tools({}, {}).summary, "there are no tools");
  EXPECT_EQ(compare_tools({grasper()}, {}).summary, "removed: 'grasper'");
  EXPECT_EQ(compare_tools({}, {grasper()}).summary, "new: 'grasper'");
  EXPECT_EQ(compare_tools({}, {grasper()}).kept, kNone);
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
      [](Tool& tool) { tool.parameters.robot_description = "robot"; },
      [](Tool& tool) { tool.parameters.urdf = "robot.urdf"; },
      [](Tool& tool) { tool.parameters.tf_prefix = "leg"; },
      [](Tool& tool) { tool.parameters.margin = 0.01; },
      [](Tool& tool) { tool.parameters.max_near = 1; },
      [](Tool& tool) { tool.joints[0] = "wrist_joint"; },
      [](Tool& tool) { tool.fault = "no file"; },
      [](Tool& tool) { tool.links.pop_back(); },
      [](Tool& tool) { tool.links[1].parts[0].radius *= 1.001; },
      [](Tool& tool) { tool.links[1].parts[0].core.points[0].x() += 1e-6; },
      [](Tool& tool) { tool.links[1].parts.push_back(tool.links[1].parts[0]); }};
  for (std::size_t i = 0; i < edits.size(); ++i) {
    Tool after = before;
    edits[i](after);
    EXPECT_EQ(compare_tools({before}, {after}).kept, kNone) << i;
  }
}

TEST(ToolChanges, AFileThatIsReadAgainIsTheSame) {
  const Tool before = loaded("gripper.urdf", {"wrist", "jaw"});
  ASSERT_EQ(before.fault, "");
  EXPECT_EQ(compare_tools({before}, {loaded("gripper.urdf", {"wrist", "jaw"})}).kept, kFirst);
}

TEST(ToolChanges, AMovedVertexOfAMeshCounts) {
  const auto with_mesh = [](double z) {
    Tool tool = grasper();
    const std::vector<Eigen::Vector3d> vertices = {{0, 0, z}, {0.1, 0, 0}, {0, 0.1, 0}};
    tool.links[0].parts = {LinkPart::mesh({vertices, {{0, 1, 2}}})};
    return tool;
  };
  EXPECT_EQ(compare_tools({with_mesh(0.01)}, {with_mesh(0.01)}).kept, kFirst);
  EXPECT_EQ(compare_tools({with_mesh(0.01)}, {with_mesh(0.011)}).kept, kNone);
}
