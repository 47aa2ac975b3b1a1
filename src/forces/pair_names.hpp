#pragma once

#include <map>
#include <string>
#include <utility>

namespace organ_collision {

/// The name of a tool in the ROS graph: `_` replaces each character other than ASCII letters,
/// digits and `_`. A name that does not begin with a letter is prefixed with "tool_".
std::string tool_graph_name(const std::string& tool);

/// Gives each pair of organ and tool its name in the ROS graph.
class PairNames {
 public:
  /// "ORGAN/TOOL", a relative name. Both parts are made as by tool_graph_name(), that of the organ
  /// with the prefix "organ_". Throws Rejection if another pair already has the name.
  std::string of(const std::string& organ, const std::string& tool);

 private:
  std::map<std::string, std::pair<std::string, std::string>> owners_;  ///< by name in the graph
};

}  // namespace organ_collision
