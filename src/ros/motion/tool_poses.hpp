#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "path_builder.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "transform_buffer.hpp"

namespace organ_collision {

/// How densely motion is sampled from TF.
struct PathSampling {
  double sample_sec;
  int samples_max;  ///< in one step, including its end
};

/// The frames that determine the pose of what is swept.
TransformBuffer::Frames swept_frames(const Tool& tool);

/// The poses of tools in the frame of an organ, from TF.
class ToolPoses {
 public:
  /// `buffer` must outlive this.
  ToolPoses(TransformBuffer& buffer, const PathSampling& sampling)
      : buffer_(buffer), sampling_(sampling) {}

  /// The pose at a time. Time zero means the latest time at which all its frames are known. The tip
  /// of links is not swept: a sample of their motion does not need it.
  Lookup<ToolPose> pose(const Tool& tool, const std::string& organ_frame, ros::Time time,
                        bool with_tip_of_links = true) const;

  /// The path from one known pose to another. It is sampled at each stamp that TF received between
  /// the two poses. If stamps are further apart than sample_sec, it is also sampled between them.
  /// Samples that TF cannot give are dropped. PathBuilder drops redundant ones, and reduces the
  /// rest to samples_max. At most max(1000, samples_max) of the stamps are read, evenly spread; if
  /// there are more, or if TF has forgotten some, the path is not wholly known.
  SampledPath path(const Tool& tool, const std::string& organ_frame, const Timed<ToolPose>& from,
                   const Timed<ToolPose>& to) const;

  /// Whether a step from `from` should end at `to`, so that its path is wholly known: it is as long
  /// as longest_step(), or has half as many poses as are read.
  bool is_nearly_forgotten(const Tool& tool, const std::string& organ_frame, ros::Time from,
                           ros::Time to) const;
  /// Half of the time for which TF keeps transforms. If a step went on for longer, TF would soon
  /// forget where the tool was at its beginning.
  ros::Duration longest_step() const { return buffer_.getCacheLength() * 0.5; }
  /// Whether a step that ended at `stamp` used transforms that are not believed any more
  /// (TransformBuffer::believed_until).
  bool is_disproved(const Tool& tool, const std::string& organ_frame, ros::Time stamp) const;

  /// Notes that a step of the tool up to `time` was answered. Transforms that come later but belong
  /// to that step are counted as late.
  void set_answered(const Tool& tool, const std::string& organ_frame, ros::Time time);

 private:
  /// Why a tool's pose is not known: `why_not`, unless no message ever came on its pose topic.
  std::string unless_silent(const ToolParameters& tool, const std::string& why_not) const;
  std::vector<ros::Time> sample_times(const Tool& tool, const std::string& organ_frame,
                                      ros::Time from, ros::Time to, SampledPath& lost) const;

  TransformBuffer& buffer_;
  PathSampling sampling_;
};

}  // namespace organ_collision
