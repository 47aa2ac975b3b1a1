#pragma once

#include <map>
#include <string>
#include <utility>

namespace organ_collision {

/// The names that pairs of organ and tool have in the ROS graph.
class PairNames {
 public:
  /// "ORGAN/TOOL", relative: each name with `_` for all but ASCII letters, digits and `_`, and with
  /// "organ_" or "tool_" before it if it begins with no letter. Throws Rejection if another pair
  /// has that name already.
  std::string of(const std::string& organ, const std::string& tool);

 private:
  std::map<std::string, std::pair<std::string, std::string>> owners_;  ///< by name in the graph
};

}  // namespace organ_collision
