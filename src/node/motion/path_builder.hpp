#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "transform_buffer.hpp"

namespace organ_collision {

/// A tool's path, and what was left out because the motion had too many samples.
struct SampledPath {
  ToolPath path = {};
  std::size_t samples_cut = 0;
  /// [m] An upper bound of the distance of a dropped pose from the path, of those that were read.
  double deviation_cut = 0.0;
  /// Which part of the motion is not known or was left out; empty: none, except for 1e-6 m.
  std::string unknown = {};
};

/// Builds a path from samples of a tool's motion. Between two samples, the tool moves as its joints
/// do. Each leg, from one waypoint to the next, costs time in a query, so redundant samples are
/// dropped, and joints that make no difference. This changes the path by at most 1e-9 m at the ends
/// of the axis and by at most 1e-6 m at all points of the links.
class PathBuilder {
 public:
  /// The path starts at fraction 0 with the pose `begin`. `frames`: the joints of swept_frames();
  /// empty: they are not known.
  PathBuilder(const std::vector<Link>& links, const ToolPose& begin,
              std::vector<FrameJoints> frames = {});

  /// Adds a sample. `fraction`: rises from call to call, up to 1.
  void add(double fraction, const ToolPose& pose, std::vector<FrameJoints> frames = {});

  /// The path through all samples. Its first and last waypoints are as given, except that a trocar
  /// that moved by at most 1e-9 m is at rest. If there are more than `legs_max` legs (at least 1),
  /// the waypoints that deviate least are dropped, with the algorithm of Douglas and Peucker
  /// (1973). Here, the deviation of a waypoint is its distance from the path at the same time. If
  /// it is above 1e-6 m, `unknown` tells it.
  SampledPath take(std::size_t legs_max);

  struct Sample {
    double fraction;
    ToolPose pose;
    std::vector<FrameJoints> frames;
  };

 private:
  std::vector<double> reaches_;  ///< [m] of each link: no point is farther from its origin
  std::vector<Sample> path_;
  double dropped_deviation_ = 0.0;  ///< sum of those dropped from the last leg, in tolerances
};

}  // namespace organ_collision
