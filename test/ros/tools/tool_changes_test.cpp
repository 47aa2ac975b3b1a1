#include "ros/tools/tool_changes.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "hand_made_tools.hpp"
#include "tool_files.hpp"

using namespace organ_collision;

namespace {

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
