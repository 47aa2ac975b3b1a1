#pragma once

#include <string>

/// The names of haptic_proxy in the ROS graph, besides those of the collision node.
namespace organ_collision::names {

inline constexpr char kHapticProxy[] = "haptic_proxy";
/// The topics of a tool, below ~TOOL.
inline constexpr char kProxy[] = "proxy", kState[] = "state";
/// The topics of an organ and a tool, below ~ORGAN/TOOL. Those of a tool have kWrench, too.
inline constexpr char kWrench[] = "wrench", kVertexForces[] = "vertex_forces";
/// The name of a proxy's TF frame is the name of its tool and this suffix.
inline constexpr char kProxyFrame[] = "_proxy";

}  // namespace organ_collision::names

namespace organ_collision {

/// The name of a tool in the ROS graph: `_` replaces each character other than ASCII letters,
/// digits and `_`. A name that does not begin with a letter is prefixed with "tool_".
std::string tool_graph_name(const std::string& tool);

/// What --help says of these names.
inline constexpr char kPairNamesHelp[] =
    "TOOL and ORGAN are the names of a tool and an organ, in which _ replaces each character that "
    "is no letter, digit or _. A name that does not begin with a letter gets the prefix tool_ or "
    "organ_.";

/// The name of an organ and a tool in the ROS graph: "ORGAN/TOOL", a relative name. Both names are
/// made as tool_graph_name() does it, but the prefix of the organ's name is "organ_".
std::string pair_graph_name(const std::string& organ, const std::string& tool);

}  // namespace organ_collision
