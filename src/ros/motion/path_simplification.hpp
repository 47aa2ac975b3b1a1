#pragma once

#include <cstddef>

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "path_deviation.hpp"

namespace organ_collision {

/// A path with fewer waypoints.
struct SimplifiedPath {
  ToolPath path;
  std::size_t dropped = 0;  ///< waypoints
  double deviation = 0.0;   ///< [m] the largest distance of a dropped waypoint from the path
};

/// Simplifies a path to at most `legs_max` legs; `legs_max` must be at least 1. Follows Douglas and
/// Peucker (1973), but compares waypoint and path at the same time. The waypoint with the largest
/// deviation is kept first.
SimplifiedPath simplify_path(ToolPath path, const PathDeviation& deviation, std::size_t legs_max);

}  // namespace organ_collision
