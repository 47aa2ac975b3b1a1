#pragma once

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "path_deviation.hpp"

namespace organ_collision {

/// Builds a path without the waypoints that add nothing: every leg costs a query of its own, and
/// between two transforms TF interpolates, mostly in a straight line. What lies on the straight way
/// between its neighbours is left out: ends of an axis to 1e-9 m, the points of links, whose
/// straight way is that of RigidMotion, to 1e-6 m. Joints in a chain follow that way only roughly.
class PathBuilder {
 public:
  /// At fraction 0. `deviation` must outlive it.
  PathBuilder(const PathDeviation& deviation, const ToolPose& begin)
      : deviation_(deviation), path_(resting_path(begin)) {}

  /// Fractions rise, up to 1.
  void add(double fraction, const ToolPose& pose);

  /// The path through all that was added: it begins and ends as given, but for 1e-9 m of a trocar
  /// at rest.
  ToolPath take();

 private:
  double bend(const ToolWaypoint& a, const ToolWaypoint& b, const ToolWaypoint& c) const;

  const PathDeviation& deviation_;
  ToolPath path_;
  double bends_left_out_ = 0.0;  ///< of the last leg, as `bend` has them
};

}  // namespace organ_collision
