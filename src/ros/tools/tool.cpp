#include "tool.hpp"

#include <utility>

#include "link_builder.hpp"
#include "link_description.hpp"
#include "robot_reader_client.hpp"
#include "ros/interface/plain_text.hpp"

namespace organ_collision {
namespace {

std::string find_text(const std::string& parameter, const ros::NodeHandle& private_node) {
  std::string resolved, text;
  // For a/b, searchParam looks only for a: a/b may be missing there.
  if (!private_node.searchParam(parameter, resolved) || !private_node.hasParam(resolved)) {
    throw ToolError("is set neither in " + private_node.getNamespace() +
                    " nor in a namespace above; load the robot's URDF there, name the parameter "
                    "that holds it, or give the tool's urdf");
  }
  if (!private_node.getParam(resolved, text)) throw ToolError("is no text; must be a URDF");
  return text;
}

}  // namespace

Tool load_tool(const ToolParameters& parameters, const ros::NodeHandle& private_node) {
  return load_tool(
      parameters, [&](const std::string& parameter) { return find_text(parameter, private_node); });
}

Tool load_tool(const ToolParameters& parameters,
               const std::function<std::string(const std::string& parameter)>& find_text) {
  Tool tool;
  tool.parameters = parameters;
  if (parameters.links.empty()) return tool;
  const bool is_file = !parameters.urdf.empty();
  try {
    std::vector<LinkDescription> links =
        is_file ? read_robot_file(parameters.urdf, parameters.links)
                : read_robot_text(find_text(parameters.robot_description), parameters.links);
    for (std::size_t i = 0; i < links.size(); ++i) {
      tool.joints.push_back(links[i].joint);
      tool.links.push_back(build_link(parameters.links[i], std::move(links[i])));
    }
  } catch (const std::exception& error) {
    tool.links.clear();
    tool.joints.clear();
    const std::string fault = parameters.name + ": " + (is_file ? "urdf " : "parameter ") + "'" +
                              (is_file ? parameters.urdf : parameters.robot_description) +
                              "': " + error.what();
    tool.fault = plain_text(fault, kLongestMessage);
  }
  return tool;
}

}  // namespace organ_collision
