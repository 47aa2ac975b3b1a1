#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <string>

#include "tool.hpp"

namespace organ_collision {

/// The tool with its links, from its URDF: a file, or a parameter that is looked for in the node's
/// private namespace and upwards from there. A bad description throws nothing: it is the tool's
/// `fault`, a sentence that begins with the tool's name.
Tool load_tool(const ToolParameters& parameters, const ros::NodeHandle& private_node);

/// The same without ROS. `find_text`: the value of a parameter; throws ToolError if there is none.
Tool load_tool(const ToolParameters& parameters,
               const std::function<std::string(const std::string& parameter)>& find_text);

}  // namespace organ_collision
