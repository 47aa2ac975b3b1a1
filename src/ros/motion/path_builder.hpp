#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

/// A tool's path, and what it lost because it had too many samples.
struct SampledPath {
  ToolPath path = {};
  std::size_t samples_cut = 0;
  /// [m] the largest distance of a dropped pose from the path; infinite if some were not even read
  double deviation_cut = 0.0;
  std::string unknown = {};  ///< what is not known of the tool's way; empty: all is known
};

/// Builds a path from samples of a tool's motion, without redundant waypoints, because each leg of
/// a path costs a query. TF interpolates between transforms, so that many samples lie on the
/// straight motion between their neighbours. Samples are dropped as long as this changes the path
/// by at most 1e-9 m at the ends of the axis and by at most 1e-6 m at all points of the links. The
/// straight motion of a link is RigidMotion; chains of joints follow it only roughly.
class PathBuilder {
 public:
  /// Starts at fraction 0.
  PathBuilder(const std::vector<Link>& links, const ToolPose& begin);

  /// Fractions rise from call to call, up to 1.
  void add(double fraction, const ToolPose& pose);

  /// The path through all samples. Its first and last waypoints are as given, except that a trocar
  /// that moved by at most 1e-9 m is at rest. If it has more than `legs_max` legs, at least 1, the
  /// waypoints that matter least are dropped, as Douglas and Peucker (1973) do, but waypoint and
  /// path are compared at the same time. The waypoint with the largest deviation is kept first.
  SampledPath take(std::size_t legs_max);

 private:
  std::vector<double> reaches_;  ///< [m] of each link: an upper bound of its points' distances
  ToolPath path_;
  double dropped_deviation_ = 0.0;  ///< sum over the samples dropped from the last leg
};

}  // namespace organ_collision
