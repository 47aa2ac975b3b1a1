#include "tool_reload.hpp"

#include <ros/console.h>

#include <exception>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/plain_text.hpp"
#include "ros/interface/plausible_size.hpp"
#include "ros/tools/link_description.hpp"

namespace organ_collision {
namespace {

/// A tool that would stop working is refused. One that did not work before may go on so.
void check(const std::vector<Tool>& tools, const KeptTools& kept) {
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (!kept[tool] && !tools[tool].fault.empty()) throw ToolError(tools[tool].fault);
  }
}

}  // namespace

std::vector<Tool> load_tools(const std::vector<ToolParameters>& parameters,
                             const ros::NodeHandle& private_node) {
  std::vector<Tool> tools;
  for (const ToolParameters& of_tool : parameters) {
    tools.push_back(load_tool(of_tool, private_node));
  }
  return tools;
}

void warn_of_settings(const std::vector<Tool>& tools, const std::vector<std::string>& misspelt) {
  for (const std::string& sentence : misspelt) ROS_WARN("%s", sentence.c_str());
  for (const Tool& tool : tools) {
    if (!tool.fault.empty()) ROS_ERROR("%s", tool.fault.c_str());
  }
  if (tools.empty()) ROS_WARN("%s", kNoTools);
  for (const Tool& tool : tools) {
    if (!tool.parameters.has_shaft()) continue;
    const std::string doubt = doubt_about_radius(tool.parameters.name, tool.parameters.radius);
    if (!doubt.empty()) ROS_WARN("%s", doubt.c_str());
  }
}

ToolReload::ToolReload(ros::NodeHandle private_node, const std::vector<Tool>& tools, Load load,
                       Exchange exchange)
    : private_node_(private_node),
      tools_(tools),
      load_(std::move(load)),
      exchange_(std::move(exchange)) {}

void ToolReload::advertise() {
  server_ = private_node_.advertiseService(names::kReloadTools, &ToolReload::on_reload, this);
}

bool ToolReload::on_reload(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    response.message = plain_text(reload(), kLongestMessage);
    response.success = true;
    ROS_INFO("tools are reloaded: %s", response.message.c_str());
  } catch (const std::exception& error) {
    response.message = plain_text(error.what(), kLongestMessage);
    ROS_WARN("tools stay as they were: %s", response.message.c_str());
  }
  return true;
}

/// Returns which tools are new, changed, unchanged and removed.
std::string ToolReload::reload() {
  LoadedTools parameters = load_();
  LoadedToolList loaded{load_tools(parameters.tools, private_node_),
                        std::move(parameters.misspelt)};
  const ToolChanges changes = compare_tools(tools_, loaded.tools);
  check(loaded.tools, changes.kept);
  exchange_(loaded, changes.kept);
  return changes.summary;
}

}  // namespace organ_collision
