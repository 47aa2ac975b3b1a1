#pragma once

#include <vector>

#include "geometry/tool/rigid_motion.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

/// The straight motion from one waypoint to another: the ends of the axis move linearly, and each
/// link moves as a RigidMotion.
struct StraightMotion {
  /// `to` has a larger fraction than `from`.
  StraightMotion(const ToolWaypoint& from, const ToolWaypoint& to);

  double begin, duration;  ///< fractions of the step
  ShaftMotion axis;
  std::vector<RigidMotion> links;
};

/// The distance of a waypoint from a straight motion at the same time [m].
struct Deviation {
  double axis;   ///< the larger deviation of the two ends of the axis
  double links;  ///< an upper bound for all points of the links

  double most() const { return axis > links ? axis : links; }
};

/// Measures deviations of one tool.
class PathDeviation {
 public:
  explicit PathDeviation(const std::vector<Link>& links);

  Deviation operator()(const ToolWaypoint& waypoint, const StraightMotion& motion) const;

 private:
  std::vector<double> reaches_;  ///< [m] of each link: an upper bound, see reach()
};

}  // namespace organ_collision
