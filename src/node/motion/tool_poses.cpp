#include "tool_poses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/messages/conversions.hpp"
#include "geometry/concatenate.hpp"
#include "geometry/plausible_size.hpp"

namespace organ_collision {
namespace {

/// [poses] The most poses that are read for a step, or samples_max if that is more. For each pose,
/// TF searches through all later transforms: without a limit, a step of many seconds would take up
/// to a second.
constexpr std::size_t kMostRead = 1000;

/// The frames of the shaft and the links. `with_tip`: and of the tip of the links, if they have
/// one.
TransformBuffer::Frames frames_of(const Tool& tool, bool with_tip) {
  TransformBuffer::Frames frames = swept_frames(tool);
  if (with_tip && tool.parameters.has_tip_of_links()) frames.push_back(tool.parameters.tip_frame);
  return frames;
}

/// What has a frame of frames_of(). Empty for the ends of a shaft, whose frames say enough.
std::string owner_of(const Tool& tool, std::size_t frame, bool is_late) {
  const std::string of_tool = " of tool '" + tool.parameters.name + "'";
  const std::size_t of_shaft = tool.parameters.has_shaft() ? 2 : 0;
  if (frame < of_shaft) return "";
  const std::size_t link = frame - of_shaft;
  if (link == tool.links.size()) return "tip" + of_tool + ": ";
  const std::string joint = is_late ? "" : tool.joints[link];
  return "link '" + tool.links[link].name + "'" + of_tool +
         (joint.empty() ? "" : " (is joint '" + joint + "' published?)") + ": ";
}

bool is_near(const ToolPose& pose) {
  return is_in_range(pose.axis.trocar) && is_in_range(pose.axis.tip) &&
         std::all_of(pose.links.begin(), pose.links.end(),
                     [](const auto& link) { return is_in_range(link.translation()); });
}

bool are_on_joints_of(const std::vector<FrameJoints>& joints,
                      const std::vector<FrameJoints>& others) {
  return std::equal(joints.begin(), joints.end(), others.begin(), others.end(),
                    [](const auto& a, const auto& b) { return a.is_on_joints_of(b); });
}

/// Whether a joint turns by so nearly half a turn, or exactly half a turn, that rounding decides in
/// which direction. TF's own pose half way tells the direction.
bool turn_by_half(const std::vector<FrameJoints>& from, const std::vector<FrameJoints>& to) {
  constexpr double kLeastTrace = -0.98;  // Of a rotation by 3 rad.
  for (std::size_t i = 0; i < to.size(); ++i) {
    for (std::size_t k = 0; k < to[i].poses.size(); ++k) {
      const auto &a = from[i].poses[k].linear(), &b = to[i].poses[k].linear();
      if (a.cwiseProduct(b).sum() < kLeastTrace) return true;
    }
  }
  return false;
}

ros::Time half_way(ros::Time from, ros::Time to) {
  ros::Time time;
  return time.fromNSec(from.toNSec() + (to.toNSec() - from.toNSec()) / 2);
}

/// How many samples, one each `spacing_sec`, lie strictly between two times that are `gap_sec`
/// apart.
double samples_between(double gap_sec, double spacing_sec) {
  return std::max(0.0, std::ceil(gap_sec / spacing_sec - 1e-6) - 1.0);
}

}  // namespace

TransformBuffer::Frames swept_frames(const Tool& tool) {
  const ToolParameters& parameters = tool.parameters;
  TransformBuffer::Frames frames;
  if (parameters.has_shaft()) frames = {parameters.trocar_frame, parameters.tip_frame};
  for (const Link& link : tool.links) frames.push_back(parameters.link_frame(link.name));
  return frames;
}

std::size_t ToolPoses::most_read() const {
  return std::max(kMostRead, static_cast<std::size_t>(sampling_.samples_max));
}

void ToolPoses::set_answered(const Tool& tool, const std::string& organ_frame, ros::Time time) {
  buffer_.set_answered(organ_frame, swept_frames(tool), time);
}

/// The stamps of the received transforms and, where these are further apart than sample_sec, evenly
/// spaced times between them. Notes in `lost` how many times samples_max has left out, and what is
/// not known of the motion.
std::vector<ToolPoses::SampleTime> ToolPoses::sample_times(const Tool& tool,
                                                           const std::string& organ_frame,
                                                           ros::Time from, ros::Time to,
                                                           SampledPath& lost) const {
  auto [stamps, forgotten] = buffer_.stamps_between(organ_frame, swept_frames(tool), from, to);
  if (forgotten > from) {
    lost.unknown = concatenate("the tool's way from ", from, " s to ", std::min(forgotten, to),
                               " s is not known: it is longer ago than transforms are kept (",
                               buffer_.getCacheLength().toSec(), " s)");
  }
  const std::size_t heard = stamps.size();
  const std::size_t most = most_read();
  if (heard > most) {
    lost.samples_cut = heard - most;
    if (lost.unknown.empty()) {
      lost.unknown = concatenate("of the tool's ", heard, " poses in this step, ", most,
                                 " were read; steps must be shorter");
    }
    std::vector<SampleTime> times;
    for (std::size_t i = 0; i < most; ++i) times.push_back({stamps[i * heard / most], true});
    return times;
  }
  stamps.push_back(to);
  const double spacing =
      std::max(sampling_.sample_sec, seconds_between(from, to) / sampling_.samples_max);
  std::vector<SampleTime> times;
  double wanted = 0.0, sampled = 0.0;
  for (const ros::Time stamp : stamps) {
    const double gap = seconds_between(from, stamp);
    const auto count = static_cast<std::int64_t>(samples_between(gap, spacing));
    const auto step = static_cast<std::uint64_t>(nanoseconds_between(from, stamp) / (count + 1));
    std::uint64_t time = from.toNSec();
    for (std::int64_t i = 0; i < count; ++i) times.emplace_back().time.fromNSec(time += step);
    times.push_back({stamp, true});
    wanted += samples_between(gap, sampling_.sample_sec);
    sampled += static_cast<double>(count);
    from = stamp;
  }
  times.pop_back();
  lost.samples_cut = static_cast<std::size_t>(wanted - sampled);
  return times;
}

bool ToolPoses::has_pose(const Tool& tool, const std::string& organ_frame, ros::Time time) const {
  const TransformBuffer::Frames frames = frames_of(tool, true);
  try {
    return std::all_of(frames.begin(), frames.end(), [&](const std::string& frame) {
      return frame == organ_frame || buffer_.canTransform(organ_frame, frame, time);
    });
  } catch (const std::runtime_error&) {  // From ros::Time for extreme stamps.
    return false;
  }
}

Lookup<ToolPose> ToolPoses::pose(const Tool& tool, const std::string& organ_frame, ros::Time time,
                                 PoseUse use) const {
  const ToolParameters& parameters = tool.parameters;
  const TransformBuffer::Frames frames = frames_of(tool, use == PoseUse::kStepEnd);
  std::vector<Eigen::Isometry3d> found;  // T_organ_frame of each frame
  found.reserve(frames.size());
  ros::Time earliest, latest;  // Zero: all transforms are static.
  for (const std::string& frame : frames) {
    const auto lookup = look_up(buffer_, organ_frame, frame, time);
    if (!lookup.found) return {std::nullopt, why_not(tool, organ_frame, found.size(), lookup)};
    found.push_back(lookup.found->value);
    const ros::Time stamp = lookup.found->stamp;
    if (stamp.isZero()) continue;
    earliest = earliest.isZero() ? stamp : std::min(earliest, stamp);
    latest = std::max(latest, stamp);
  }
  // For time zero, each frame was looked up at its own latest time. All poses must be of the same
  // time, so they are looked up again at the earliest of these times.
  if (earliest != latest) return this->pose(tool, organ_frame, earliest, use);
  ToolPose pose{{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}};
  auto next = found.begin();
  if (parameters.has_shaft()) {
    const Eigen::Isometry3d &trocar = *next++, &tip = *next++;
    pose.axis = {trocar * parameters.trocar_offset, tip * parameters.tip_offset};
  }
  const auto end = next + static_cast<std::ptrdiff_t>(tool.links.size());
  pose.links.assign(next, end);
  if (end != found.end()) pose.tip = *end * parameters.tip_offset;
  return {{{std::move(pose), earliest}}, ""};
}

ros::Time ToolPoses::velocity_begin(ros::Time history_begin, ros::Time end) {
  constexpr auto kSpan = static_cast<std::uint64_t>(1e9 * kVelocitySec);
  const std::uint64_t time = end.toNSec();
  return std::max(history_begin, ros::Time().fromNSec(time - std::min(kSpan, time)));
}

std::optional<ToolPose> ToolPoses::pose_before(const Tool& tool, const std::string& organ_frame,
                                               ros::Time begin, ros::Time end,
                                               ros::Time now) const {
  const bool moves =
      !begin.isZero() && begin < end && buffer_.goes_on(organ_frame, swept_frames(tool), end, now);
  if (!moves) return std::nullopt;
  auto before = pose(tool, organ_frame, begin, PoseUse::kSample);
  if (!before.found) return std::nullopt;
  return std::move(before.found->value);
}

bool ToolPoses::is_nearly_forgotten(const Tool& tool, const std::string& organ_frame,
                                    ros::Time from, ros::Time to) const {
  return seconds_between(from, to) >= longest_step().toSec() ||
         buffer_.stamps_between(organ_frame, swept_frames(tool), from, to).rising.size() >=
             kMostRead / 2;
}

std::string ToolPoses::missed(const Tool& tool, const std::string& organ_frame,
                              std::size_t seen) const {
  const std::string frame = buffer_.late_frame(organ_frame, swept_frames(tool), seen);
  if (frame.empty()) return "";
  return "a transform of frame '" + frame + "' came behind a stamp that was already answered";
}

std::string ToolPoses::why_not(const Tool& tool, const std::string& organ_frame,
                               std::size_t missing, const Lookup<Eigen::Isometry3d>& lookup) const {
  const std::string &topic = tool.parameters.tip_pose_topic, &tip = tool.parameters.tip_frame;
  if (!topic.empty()) {
    const std::string refusal = buffer_.refusal(tip);
    if (!refusal.empty()) return "the last pose on " + topic + " " + refusal;
    if (!buffer_.has_heard(tip)) return "no pose came on " + topic;
  }
  if (lookup.unknown_frame == organ_frame) {
    return lookup.why_not + "; it is the frame of the organ or of the node, not of the tool";
  }
  std::string why = owner_of(tool, missing, lookup.is_late) + lookup.why_not;
  if (topic.empty() || !lookup.is_late) return why;
  const std::string frame = frames_of(tool, true)[missing];
  const auto oldest = buffer_.oldest_transform(frame, {organ_frame});
  const auto of_organ = buffer_.oldest_transform(organ_frame, {frame});
  if (!oldest || oldest->frame != tip) return why;
  if (of_organ && of_organ->received < oldest->received) return why;
  return why + ": poses on " + topic +
         " come seldom; see 'Send poses also while nothing moves' in doc/tools.md";
}

SampledPath ToolPoses::path(const Tool& tool, const std::string& organ_frame,
                            const Timed<ToolPose>& from, const Timed<ToolPose>& to) const {
  const auto duration = static_cast<double>(nanoseconds_between(from.stamp, to.stamp));
  const TransformBuffer::Frames frames = swept_frames(tool);
  const auto joints_at = [&](ros::Time time) {
    std::vector<FrameJoints> joints;
    for (const std::string& frame : frames) {
      joints.push_back(buffer_.joints(organ_frame, frame, time));
    }
    return joints;
  };
  std::vector<FrameJoints> last = joints_at(from.stamp);
  ros::Time last_time = from.stamp;
  PathBuilder path(tool.links, from.value, last);
  SampledPath sampled;
  const auto pose_at = [&](ros::Time time) {
    auto found = pose(tool, organ_frame, time, PoseUse::kSample);
    // A sample that is too far away to be evaluated must not make the whole step fail.
    if (found.found && is_near(found.found->value)) return std::move(found.found);
    if (sampled.unknown.empty()) {
      sampled.unknown = concatenate(
          "the tool's pose at ", time,
          " s is not known: ", found.found ? "it is too far away to be evaluated" : found.why_not);
    }
    return std::optional<Timed<ToolPose>>();
  };
  const auto add = [&](ros::Time time, const ToolPose& pose, std::vector<FrameJoints> joints) {
    const auto passed = static_cast<double>(nanoseconds_between(from.stamp, time));
    path.add(time == to.stamp ? 1.0 : passed / duration, pose, std::move(joints));
  };
  std::vector<ros::Time> between;
  const auto add_heard = [&](ros::Time time, const ToolPose& pose) {
    std::vector<FrameJoints> joints = joints_at(time);
    if (!are_on_joints_of(joints, last)) {
      // What TF does in between is not known, for example because a frame got another parent.
    } else if (turn_by_half(last, joints)) {
      between = {half_way(last_time, time)};
    } else {
      between.clear();
    }
    for (const ros::Time sample : between) {
      if (const auto found = pose_at(sample)) add(sample, found->value, joints_at(sample));
    }
    between.clear();
    last = joints;
    last_time = time;
    add(time, pose, std::move(joints));
  };
  for (const auto& [time, is_heard] :
       sample_times(tool, organ_frame, from.stamp, to.stamp, sampled)) {
    if (!is_heard) {
      between.push_back(time);
    } else if (const auto found = pose_at(time)) {
      add_heard(time, found->value);
    }
  }
  add_heard(to.stamp, to.value);
  SampledPath built = path.take(static_cast<std::size_t>(sampling_.samples_max));
  sampled.path = std::move(built.path);
  sampled.samples_cut += built.samples_cut;
  sampled.deviation_cut = built.deviation_cut;
  if (sampled.unknown.empty()) sampled.unknown = std::move(built.unknown);
  return sampled;
}

}  // namespace organ_collision
