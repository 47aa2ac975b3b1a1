#pragma once

#include <tf2/buffer_core.h>

#include <cstddef>
#include <string>

#include "organ_collision/geometry/shaft.hpp"
#include "organ_collision/ros/parameters.hpp"
#include "organ_collision/ros/transforms.hpp"

namespace organ_collision {

/// How finely motion is read from TF.
struct PathSampling {
  double sample_sec;
  int samples_max;  ///< for each step, its end among them
};

/// A tool's way, and how many samples it would have had more without `samples_max`.
struct SampledPath {
  ShaftPath path;
  std::size_t samples_cut = 0;
};

/// Where tools are, in the frame of an organ, from TF.
class ToolPoses {
 public:
  /// `buffer` must outlive it.
  ToolPoses(const tf2::BufferCore& buffer, const PathSampling& sampling)
      : buffer_(buffer), sampling_(sampling) {}

  /// The axis at a time; zero: at the latest time for which both its frames are known.
  Lookup<ShaftAxis> axis(const ToolParameters& tool, const std::string& organ_frame,
                         ros::Time time) const;

  /// The way from one known axis to another, through samples of TF evenly spaced in between; a
  /// sample that TF does not have, or that lies on the straight way between its neighbours, is left
  /// out. A path always begins and ends as given, but for 1e-9 m of a trocar at rest.
  SampledPath path(const ToolParameters& tool, const std::string& organ_frame,
                   const Timed<ShaftAxis>& from, const Timed<ShaftAxis>& to) const;

 private:
  const tf2::BufferCore& buffer_;
  PathSampling sampling_;
};

}  // namespace organ_collision
