#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <string>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "ros/parameters/node_parameters.hpp"

namespace organ_collision {

/// A tool as the node uses it.
struct Tool {
  ToolParameters parameters;
  std::vector<Link> links;          ///< in the order of parameters.links
  std::vector<std::string> joints;  ///< of each link: the joint that moves it, or empty
  std::string fault;  ///< why the links could not be loaded; empty if there was no error
};

/// What the log and /diagnostics say about an empty list of tools.
inline constexpr char kNoTools[] =
    "~tools is empty: no contacts are published, and only queries that give a motion are answered; "
    "set ~tools and call ~reload_tools, or start the node anew";

/// The tool, with its links from its URDF. The URDF is a file, or a parameter that is searched in
/// the node's private namespace and upwards from there. A bad description is not thrown: the tool
/// gets a `fault`, a sentence that begins with the tool's name.
Tool load_tool(const ToolParameters& parameters, const ros::NodeHandle& private_node);

/// The same without a parameter server. `find_text` returns the value of a parameter, or throws
/// ToolError.
Tool load_tool(const ToolParameters& parameters,
               const std::function<std::string(const std::string& parameter)>& find_text);

}  // namespace organ_collision
