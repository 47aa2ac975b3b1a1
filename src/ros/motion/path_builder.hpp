#pragma once

#include <cstddef>
#include <vector>

#include "geometry/tool/leg_motion.hpp"
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

/// Builds a path from samples of a tool's motion, without redundant waypoints, because each leg of
/// a path costs a query. TF interpolates between transforms, so that many samples lie on the
/// straight motion between their neighbours. Samples are dropped as long as this changes the path
/// by at most 1e-9 m at the ends of the axis and by at most 1e-6 m at all points of the links. The
/// straight motion of a link is RigidMotion; chains of joints follow it only roughly.
class PathBuilder {
 public:
  /// Starts at fraction 0. `deviation` must outlive this.
  PathBuilder(const PathDeviation& deviation, const ToolPose& begin)
      : deviation_(deviation), path_(resting_path(begin)) {}

  /// Fractions rise from call to call, up to 1.
  void add(double fraction, const ToolPose& pose);

  /// The path through all samples. Its first and last waypoints are as given, except that a trocar
  /// that moved by at most 1e-9 m is at rest.
  ToolPath take();

 private:
  double relative_deviation(const ToolWaypoint& a, const ToolWaypoint& b,
                            const ToolWaypoint& c) const;

  const PathDeviation& deviation_;
  ToolPath path_;
  double dropped_deviation_ = 0.0;  ///< sum over the samples dropped from the last leg
};

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
