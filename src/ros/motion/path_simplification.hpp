#pragma once

#include <cstddef>

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "path_deviation.hpp"

namespace organ_collision {

/// A path with the waypoints that fit into so many legs, and what the others were.
struct CutPath {
  ToolPath path;
  std::size_t cut = 0;     ///< waypoints left out
  double deviation = 0.0;  ///< [m] the farthest that any of them is from the path
};

/// Leaves out waypoints until there are at most `legs_max` legs, at least 1: those that change the
/// way least, as Douglas and Peucker (1973) find them.
CutPath cut_path(ToolPath path, const PathDeviation& deviation, std::size_t legs_max);

}  // namespace organ_collision
