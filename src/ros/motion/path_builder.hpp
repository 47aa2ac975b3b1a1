#pragma once

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "path_deviation.hpp"

namespace organ_collision {

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

}  // namespace organ_collision
