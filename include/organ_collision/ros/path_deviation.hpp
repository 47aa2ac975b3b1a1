#pragma once

#include <vector>

#include "organ_collision/geometry/link.hpp"
#include "organ_collision/geometry/tool_path.hpp"

namespace organ_collision {

/// How far a waypoint is from the straight way between two others, at its time [m].
struct Deviation {
  double axis;   ///< of either end of the axis
  double links;  ///< of any point of the links, whose straight way is that of RigidMotion, or more

  double most() const { return axis > links ? axis : links; }
};

/// Measures the waypoints of one tool.
class PathDeviation {
 public:
  explicit PathDeviation(const std::vector<Link>& links);

  /// Of `b` from the way from `a` to `c`; their fractions rise.
  Deviation operator()(const ToolWaypoint& a, const ToolWaypoint& b, const ToolWaypoint& c) const;

 private:
  std::vector<double> reaches_;  ///< [m] of each link, from its origin
};

}  // namespace organ_collision
