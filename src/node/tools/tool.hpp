#pragma once

#include <organ_collision/ToolInfo.h>
#include <ros/node_handle.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/messages/robot_reply.hpp"
#include "node/parameters/node_parameters.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

/// Makes a link from its description. Throws ToolError, which names the link and the illegal size,
/// pose or mesh.
Link build_link(const std::string& name, const RobotLink& description);

/// A tool with its links, as the node uses it.
struct Tool {
  ToolParameters parameters;
  std::vector<Link> links;          ///< in the order of parameters.links
  std::vector<std::string> joints;  ///< for each link: the joint that moves it, or empty
  std::size_t fingerprint = 0;      ///< a hash of what the robot's files say of links and joints
  std::string fault;          ///< why the links could not be loaded; empty if there was no error
  std::uint64_t history = 0;  ///< the number of its history: that of a tool which is kept stays
};

/// Sentences about what is legal, but probably a mistake: the radius of the shaft, and the sizes of
/// the links.
std::vector<std::string> doubts(const Tool& tool);

/// A sentence if the tool is implausibly far away from the box around an organ; or empty.
/// `T_organ_tool`: from the frame of the tool's pose.
std::string doubt_about_place(const ToolParameters& tool, const ShaftAxis& axis,
                              const std::vector<Eigen::Isometry3d>& links,
                              const Eigen::Isometry3d& T_organ_tool, const std::string& organ,
                              const Eigen::AlignedBox3f& box);

/// What list_tools says of a tool.
ToolInfo info_of(const Tool& tool);

/// What the log and /diagnostics say about an empty list of tools.
inline constexpr char kNoTools[] =
    "~tools is empty: no contacts are published, and only queries that give a motion are answered; "
    "set ~tools and call ~reload_tools, or start the node anew";

/// Returns the value of a parameter, or throws ToolError.
using FindText = std::function<std::string(const std::string& parameter)>;

/// Loads the links of a tool from its URDF, which is a file or the value of a parameter. Does not
/// throw if the description is bad: the tool then has a `fault`, a sentence that begins with the
/// tool's name.
Tool load_tool(const ToolParameters& parameters, const FindText& find_text);

/// Loads all tools of a node. Parameters are searched in the node's private namespace and upwards
/// from there.
std::vector<Tool> load_tools(const std::vector<ToolParameters>& parameters,
                             const ros::NodeHandle& private_node);

/// For each tool of a new list: its index in the old list if the tool is unchanged; std::nullopt if
/// it is new or changed.
using KeptTools = std::vector<std::optional<std::size_t>>;

/// How a new list of tools differs from the old one.
struct ToolChanges {
  KeptTools kept;
  std::string summary;  ///< names the unchanged, changed, new and removed tools
};

/// A tool is unchanged if its name, its parameters, the shapes and joints of its links, and its
/// fault are the same in both lists.
ToolChanges compare_tools(const std::vector<Tool>& old_tools, const std::vector<Tool>& new_tools);

}  // namespace organ_collision
