#pragma once

#include <tf2/buffer_core.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "organ_collision/geometry/tool_path.hpp"
#include "organ_collision/ros/parameters.hpp"
#include "organ_collision/ros/pose_stamps.hpp"
#include "organ_collision/ros/tool.hpp"
#include "organ_collision/ros/transforms.hpp"

namespace organ_collision {

/// How finely motion is read from TF.
struct PathSampling {
  double sample_sec;
  int samples_max;  ///< for each step, its end among them
};

/// A tool's way, and how many samples it would have had more without `samples_max`.
struct SampledPath {
  ToolPath path;
  std::size_t samples_cut = 0;
};

/// Where tools are, in the frame of an organ, from TF.
class ToolPoses {
 public:
  /// `buffer` must outlive it.
  ToolPoses(const tf2::BufferCore& buffer, const PathSampling& sampling)
      : buffer_(buffer), sampling_(sampling) {}

  /// The pose at a time; zero: at the latest time for which all its frames are known.
  Lookup<ToolPose> pose(const Tool& tool, const std::string& organ_frame, ros::Time time) const;

  /// The way from one known pose to another, through samples of TF in between: evenly spaced, and
  /// at the stamps of poses of the tip that came as messages. A sample that TF does not have is
  /// left out; of the others, PathBuilder keeps those that add something.
  SampledPath path(const Tool& tool, const std::string& organ_frame, const Timed<ToolPose>& from,
                   const Timed<ToolPose>& to) const;

  /// A pose of the tool's tip came as a message, and is in the buffer.
  void add_sample(const ToolParameters& tool, ros::Time stamp);
  void forget_samples() { stamps_.clear(); }

 private:
  /// Why a tool's pose is not known: no message came that would have placed it, or as given.
  std::string unless_silent(const ToolParameters& tool, const std::string& why_not) const;
  std::vector<ros::Time> sample_times(const ToolParameters& tool, ros::Time from, ros::Time to,
                                      std::size_t& cut) const;

  const tf2::BufferCore& buffer_;
  PathSampling sampling_;
  std::map<std::string, PoseStamps> stamps_;  ///< by tool
};

}  // namespace organ_collision
