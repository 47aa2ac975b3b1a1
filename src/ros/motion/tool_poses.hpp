#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "transform_buffer.hpp"
#include "transform_lookup.hpp"

namespace organ_collision {

/// How finely motion is read from TF.
struct PathSampling {
  double sample_sec;
  int samples_max;  ///< for each step, its end among them
};

/// A tool's way, and what it would have more without `samples_max`.
struct SampledPath {
  ToolPath path;
  std::size_t samples_cut = 0;
  double deviation_cut = 0.0;  ///< [m] the farthest that a pose read and left out is from the path
};

/// Where tools are, in the frame of an organ, from TF.
class ToolPoses {
 public:
  /// `buffer` must outlive it.
  ToolPoses(TransformBuffer& buffer, const PathSampling& sampling)
      : buffer_(buffer), sampling_(sampling) {}

  /// The pose at a time; zero: at the latest time for which all its frames are known.
  Lookup<ToolPose> pose(const Tool& tool, const std::string& organ_frame, ros::Time time) const;

  /// The way from one known pose to another, through all that TF was told in between, and through
  /// samples where that is seldom. A sample that TF does not have is left out; of the others,
  /// PathBuilder keeps those that add something and, if they are too many, cut_path those that add
  /// most. Of more than a thousand, and than samples_max, those read are spread evenly.
  SampledPath path(const Tool& tool, const std::string& organ_frame, const Timed<ToolPose>& from,
                   const Timed<ToolPose>& to) const;

  /// A step of the tool up to `time` was answered: transforms that it should have gone through and
  /// that are still to come are late.
  void set_answered(const Tool& tool, const std::string& organ_frame, ros::Time time);

 private:
  /// Why a tool's pose is not known: no message came that would have placed it, or as given.
  std::string unless_silent(const ToolParameters& tool, const std::string& why_not) const;
  std::vector<ros::Time> sample_times(const Tool& tool, const std::string& organ_frame,
                                      ros::Time from, ros::Time to, std::size_t& cut) const;

  TransformBuffer& buffer_;
  PathSampling sampling_;
};

}  // namespace organ_collision
