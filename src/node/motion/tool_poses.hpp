#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "node/parameters/node_parameters.hpp"
#include "node/tools/tool.hpp"
#include "path_builder.hpp"
#include "transform_buffer.hpp"

namespace organ_collision {

/// How densely the motion of tools is sampled from TF.
struct PathSampling {
  double sample_sec;
  int samples_max;  ///< most samples in one step, with its end
};

/// The frames that determine the poses of the shaft and the links, which are what is swept.
TransformBuffer::Frames swept_frames(const Tool& tool);

/// The poses of tools in the frame of an organ, from TF.
class ToolPoses {
 public:
  /// `buffer` must outlive this.
  ToolPoses(TransformBuffer& buffer, const PathSampling& sampling)
      : buffer_(buffer), sampling_(sampling) {}

  /// What a pose is for. The tip of links is looked up for the end of a step only, because it is
  /// not swept.
  enum class PoseUse { kStepEnd, kSample };
  /// The pose of a tool at a time. Time zero means the latest time at which all frames of the tool
  /// are known.
  Lookup<ToolPose> pose(const Tool& tool, const std::string& organ_frame, ros::Time time,
                        PoseUse use = PoseUse::kStepEnd) const;

  /// Since when the motion of a tool counts for its velocity at the end of a step: for
  /// kVelocitySec, but not before its history begins.
  static ros::Time velocity_begin(ros::Time history_begin, ros::Time end);
  /// The pose at `begin`, from which the tool has come with the velocity that it has at `end`.
  /// Empty if the tool rests: this pose is not known, or newer transforms are overdue
  /// (TransformBuffer::goes_on()).
  std::optional<ToolPose> pose_before(const Tool& tool, const std::string& organ_frame,
                                      ros::Time begin, ros::Time end, ros::Time now) const;

  /// Whether TF has all frames of the tool at a time. Costs a thirtieth of a pose() that is not
  /// found, because no error is put into words.
  bool has_pose(const Tool& tool, const std::string& organ_frame, ros::Time time) const;

  /// The path from one known pose to another. It is sampled at each stamp that TF received between
  /// the two poses. Between these stamps, the tool moves as its joints do, which is exactly what TF
  /// interpolates. Where a frame has got another parent, the path is sampled each sample_sec.
  /// Samples that TF cannot give are dropped. PathBuilder drops redundant samples, and reduces the
  /// others to samples_max. At most max(1000, samples_max) of the stamps are read, evenly spread.
  /// If there are more stamps, or if TF has forgotten some, a part of the path is unknown.
  SampledPath path(const Tool& tool, const std::string& organ_frame, const Timed<ToolPose>& from,
                   const Timed<ToolPose>& to) const;

  /// Whether a step from `from` should end at `to`, so that no part of its path is unknown: the
  /// step is as long as longest_step(), or has half as many poses as path() reads.
  bool is_nearly_forgotten(const Tool& tool, const std::string& organ_frame, ros::Time from,
                           ros::Time to) const;
  /// Half of the time for which TF keeps transforms. If a step went on for longer, TF would soon
  /// forget where the tool was at its beginning.
  ros::Duration longest_step() const { return buffer_.getCacheLength() * 0.5; }

  /// Notes that a step of the tool up to `time` was answered. Transforms that come later but belong
  /// to that step are counted as late.
  void set_answered(const Tool& tool, const std::string& organ_frame, ros::Time time);
  /// How many transforms came late, of all tools.
  std::size_t late() const { return buffer_.late(); }
  /// A sentence if a transform of the tool came late after the first `seen` of them, so that a step
  /// that was answered did not sweep the tool through it; or empty.
  std::string missed(const Tool& tool, const std::string& organ_frame, std::size_t seen) const;

 private:
  /// The most stamps that are read for a step.
  std::size_t most_read() const;
  /// Why a tool's pose is not known, if `lookup` of its frame number `missing` found nothing. If no
  /// message ever came on the tool's pose topic, or the last one was refused, this is the reason.
  std::string why_not(const Tool& tool, const std::string& organ_frame, std::size_t missing,
                      const Lookup<Eigen::Isometry3d>& lookup) const;
  struct SampleTime {
    ros::Time time;
    bool is_heard = false;  ///< a transform has this stamp
  };
  std::vector<SampleTime> sample_times(const Tool& tool, const std::string& organ_frame,
                                       ros::Time from, ros::Time to, SampledPath& lost) const;

  TransformBuffer& buffer_;
  PathSampling sampling_;
};

}  // namespace organ_collision
