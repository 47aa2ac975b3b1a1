#pragma once

#include <vector>

#include "geometry/tool/rigid_motion.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

/// The straight way from one waypoint to another: ends of the axis linearly, links as RigidMotion
/// says.
struct StraightWay {
  /// Their fractions rise.
  StraightWay(const ToolWaypoint& from, const ToolWaypoint& to);

  double begin, duration;  ///< fractions of the step
  ShaftMotion axis;
  std::vector<RigidMotion> links;
};

/// How far a waypoint is from a straight way, at its time [m].
struct Deviation {
  double axis;   ///< of either end of the axis
  double links;  ///< of any point of the links, or more

  double most() const { return axis > links ? axis : links; }
};

/// Measures the waypoints of one tool.
class PathDeviation {
 public:
  explicit PathDeviation(const std::vector<Link>& links);

  Deviation operator()(const ToolWaypoint& waypoint, const StraightWay& way) const;

 private:
  std::vector<double> reaches_;  ///< [m] of each link, from its origin
};

}  // namespace organ_collision
