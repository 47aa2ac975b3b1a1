#pragma once

#include <map>
#include <string>
#include <utility>

namespace organ_collision {

/// Gives each pair of organ and tool its name in the ROS graph.
class PairNames {
 public:
  /// "ORGAN/TOOL", a relative name. In both parts `_` replaces each character other than ASCII
  /// letters, digits and `_`. A part that does not begin with a letter is prefixed with "organ_" or
  /// "tool_". Throws Rejection if another pair already has the name.
  std::string of(const std::string& organ, const std::string& tool);

 private:
  std::map<std::string, std::pair<std::string, std::string>> owners_;  ///< by name in the graph
};

}  // namespace organ_collision
