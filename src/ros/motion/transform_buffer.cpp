#include "transform_buffer.hpp"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "geometry/concatenate.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {

namespace {

/// [parents] A frame rarely changes its parent, for example when an instrument is handed over.
constexpr std::size_t kMostParents = 8;
/// [stamps] As many transforms of a frame as TF keeps at 1 kHz.
constexpr std::size_t kMostStamps = 10'000;

template <typename Frame>
bool contains(const std::vector<Frame>& frames, const Frame& frame) {
  return std::find(frames.begin(), frames.end(), frame) != frames.end();
}

void insert(std::vector<std::size_t>& frames, std::size_t frame) {
  if (!contains(frames, frame)) frames.push_back(frame);
}

using NotFound = Lookup<Eigen::Isometry3d>;

/// [s] In whole nanoseconds, because ros::Duration overflows for extreme stamps.
double elapsed_sec(ros::Time from, ros::Time to) {
  return 1e-9 * static_cast<double>(to.toNSec() - from.toNSec());
}

/// The latest time at which the transform is known; zero if there is none.
ros::Time latest(const tf2::BufferCore& buffer, const std::string& target,
                 const std::string& source) {
  try {
    return buffer.lookupTransform(target, source, ros::Time(0)).header.stamp;
  } catch (const std::runtime_error&) {
    return {};
  }
}

/// The frame and those above it, each once.
std::vector<std::string> upward(const tf2::BufferCore& buffer, const std::string& frame) {
  std::vector<std::string> frames{frame};
  std::string parent;
  while (buffer._getParent(frames.back(), ros::Time(0), parent) && !contains(frames, parent)) {
    frames.push_back(parent);
  }
  return frames;
}

NotFound unknown(const std::string& frame) {
  return {std::nullopt, "frame '" + frame + "' is unknown to TF"};
}

NotFound late(const std::string& target, const std::string& source, ros::Time latest,
              ros::Time time) {
  const std::string text =
      concatenate("TF from '", source, "' to '", target, "' is ",
                  duration_text(elapsed_sec(latest, time)), " behind the stamp ", time);
  return {std::nullopt, text, true};
}

/// `error`: what tf2 threw.
NotFound not_found(const tf2::BufferCore& buffer, const std::string& target,
                   const std::string& source, ros::Time time, const std::runtime_error& error) {
  if (!buffer._frameExists(source)) return unknown(source);
  if (!buffer._frameExists(target)) return unknown(target);
  if (dynamic_cast<const tf2::ConnectivityException*>(&error) != nullptr) {
    return {std::nullopt, "frame '" + source + "' is not connected to '" + target + "' on TF"};
  }
  if (dynamic_cast<const tf2::ExtrapolationException*>(&error) != nullptr) {
    const ros::Time newest = latest(buffer, target, source);
    if (!newest.isZero() && newest < time) return late(target, source, newest, time);
  }
  // The text may be long: for a loop, tf2 lists all frames.
  return {std::nullopt, "no transform from " + source + " to " + target + ": " +
                            plain_text(error.what(), kLongestMessage)};
}

}  // namespace

bool TransformBuffer::add(const geometry_msgs::TransformStamped& transform,
                          const std::string& authority, bool resting) {
  const ros::Time stamp = transform.header.stamp;
  const bool taken = setTransform(transform, authority, resting);
  const auto known = indices_.find(tf_frame(transform.child_frame_id));
  if (!resting && known != indices_.end()) {
    const Frame& frame = frames_[known->second];
    // A repeated transform is not late.
    if (stamp <= frame.answered && !frame.has(stamp)) ++late_;
  }
  if (!taken) return false;
  const std::size_t parent = index_of(tf_frame(transform.header.frame_id));
  Frame& frame = frames_[index_of(tf_frame(transform.child_frame_id))];
  if (!resting) {
    judge(frame, stamp);
    note(frame, stamp);
    latest_ = std::max(latest_, stamp);
  }
  insert(frame.parents, parent);
  if (frame.parents.size() > kMostParents) frame.parents.erase(frame.parents.begin());
  return true;
}

/// Finds out whether a new stamp of the frame disproves an earlier one, or reaches the one that was
/// disproved.
void TransformBuffer::judge(Frame& frame, ros::Time stamp) {
  const ros::Time latest = frame.stamps.empty() ? ros::Time() : frame.stamps.back();
  const bool was_disproved = !frame.disproved.isZero();
  if (latest > ros::Time::now() && stamp.toSec() < latest.toSec() - kClockTolerance) {
    frame.disproved = latest;
    has_stepped_back_ = true;
  } else if (stamp >= frame.disproved) {
    frame.disproved = ros::Time();
  }
  disproved_ += static_cast<std::size_t>(!frame.disproved.isZero());
  disproved_ -= static_cast<std::size_t>(was_disproved);
}

/// A stamp is forgotten when TF forgets the transform, or when there are too many.
void TransformBuffer::note(Frame& frame, ros::Time stamp) {
  std::deque<ros::Time>& stamps = frame.stamps;
  frame.heard = stamp;
  stamps.insert(std::upper_bound(stamps.begin(), stamps.end(), stamp), stamp);
  // In whole nanoseconds, because the arithmetic of ros::Time throws for extreme stamps.
  const std::uint64_t latest = stamps.back().toNSec();
  const auto kept = static_cast<std::uint64_t>(getCacheLength().toNSec());
  while (stamps.size() > kMostStamps || latest - stamps.front().toNSec() > kept) {
    frame.forgotten = std::max(frame.forgotten, stamps.front());
    stamps.pop_front();
  }
}

bool TransformBuffer::Frame::has(ros::Time stamp) const {
  return std::binary_search(stamps.begin(), stamps.end(), stamp);
}

bool TransformBuffer::has(const std::string& frame, ros::Time stamp) const {
  const auto known = indices_.find(tf_frame(frame));
  return known != indices_.end() && frames_[known->second].has(stamp);
}

void TransformBuffer::clear() {
  BufferCore::clear();
  for (Frame& frame : frames_) frame = {{}, {}, {}, {}, {}, std::move(frame.parents)};
  latest_ = ros::Time();
  disproved_ = 0;
  has_stepped_back_ = false;
}

std::optional<ros::Time> TransformBuffer::believed_until(const std::string& target,
                                                         const Frames& sources) const {
  if (disproved_ == 0) return std::nullopt;
  std::optional<ros::Time> until;
  for (const std::size_t frame : chain(target, sources)) {
    if (frames_[frame].disproved.isZero()) continue;
    const ros::Time heard = frames_[frame].heard;
    until = until ? std::min(*until, heard) : heard;
  }
  return until;
}

bool TransformBuffer::has_heard(const std::string& frame) const {
  const auto known = indices_.find(frame);
  return known != indices_.end() && !frames_[known->second].stamps.empty();
}

TransformBuffer::Stamps TransformBuffer::stamps_between(const std::string& target,
                                                        const Frames& sources, ros::Time from,
                                                        ros::Time to) const {
  Stamps found;
  std::vector<ros::Time>& rising = found.rising;
  for (const std::size_t index : chain(target, sources)) {
    const Frame& frame = frames_[index];
    found.forgotten = std::max(found.forgotten, frame.forgotten);
    if (to <= from) continue;
    const auto begin = std::upper_bound(frame.stamps.begin(), frame.stamps.end(), from);
    rising.insert(rising.end(), begin, std::lower_bound(begin, frame.stamps.end(), to));
  }
  std::sort(rising.begin(), rising.end());
  rising.erase(std::unique(rising.begin(), rising.end()), rising.end());
  return found;
}

void TransformBuffer::set_answered(const std::string& target, const Frames& sources,
                                   ros::Time stamp) {
  for (const std::size_t frame : chain(target, sources)) {
    frames_[frame].answered = std::max(frames_[frame].answered, stamp);
  }
}

std::size_t TransformBuffer::index_of(const std::string& frame) {
  const auto [known, is_new] = indices_.try_emplace(frame, frames_.size());
  if (is_new) frames_.emplace_back();
  return known->second;
}

/// The frames whose transforms determine the poses of `sources` in the target frame. If one of them
/// changed its parent recently, further frames above it may be included.
TransformBuffer::Indices TransformBuffer::chain(const std::string& target,
                                                const Frames& sources) const {
  const Indices above_target = upward(target);
  Indices found;
  for (const std::string& source : sources) {
    const Indices above_source = upward(source);
    const bool is_tree = is_line(above_target) && is_line(above_source);
    for (const std::size_t frame : above_source) {
      if (!is_tree || !contains(above_target, frame)) insert(found, frame);
    }
    for (const std::size_t frame : above_target) {
      if (!is_tree || !contains(above_source, frame)) insert(found, frame);
    }
  }
  return found;
}

/// The frame and all its ancestors through recent parents, each once.
TransformBuffer::Indices TransformBuffer::upward(const std::string& frame) const {
  Indices found;
  if (const auto known = indices_.find(frame); known != indices_.end()) found = {known->second};
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const std::size_t parent : frames_[found[i]].parents) insert(found, parent);
  }
  return found;
}

/// Whether each of these frames has at most one recent parent.
bool TransformBuffer::is_line(const Indices& frames) const {
  return std::all_of(frames.begin(), frames.end(),
                     [&](std::size_t frame) { return frames_[frame].parents.size() <= 1; });
}

Lookup<Eigen::Isometry3d> look_up(const TransformBuffer& buffer, const std::string& target,
                                  const std::string& source, ros::Time time) {
  if (target == source) return {{{Eigen::Isometry3d::Identity(), time}}, ""};
  const std::optional<ros::Time> until = buffer.believed_until(target, {source});
  if (until && time > *until) return late(target, source, *until, time);
  try {
    geometry_msgs::TransformStamped found = buffer.lookupTransform(target, source, time);
    if (until && found.header.stamp > *until) {
      found = buffer.lookupTransform(target, source, *until);
    }
    const Eigen::Isometry3d T_target_source = to_eigen(found.transform);
    if (!T_target_source.matrix().allFinite()) {
      return {std::nullopt, "transform from " + source + " to " + target + " is not finite"};
    }
    return {{{T_target_source, time.isZero() ? found.header.stamp : time}}, ""};
  } catch (const std::runtime_error& error) {  // From tf2, or from ros::Time for extreme stamps.
    return not_found(buffer, target, source, time, error);
  }
}

bool has_transform(const TransformBuffer& buffer, const std::string& target,
                   const std::string& source, ros::Time time) {
  if (target == source) return true;
  const std::optional<ros::Time> until = buffer.believed_until(target, {source});
  try {
    return !(until && time > *until) && buffer.canTransform(target, source, time);
  } catch (const std::runtime_error&) {  // From ros::Time for extreme stamps.
    return false;
  }
}

std::optional<NewestTransform> oldest_transform(const TransformBuffer& buffer,
                                                const std::string& frame,
                                                const std::vector<std::string>& others) {
  std::vector<std::vector<std::string>> above_others;
  for (const std::string& other : others) above_others.push_back(upward(buffer, other));
  const std::vector<std::string> above = upward(buffer, frame);
  std::optional<NewestTransform> oldest;
  for (std::size_t i = 0; i + 1 < above.size(); ++i) {
    const bool carries_all =
        std::all_of(above_others.begin(), above_others.end(),
                    [&](const auto& frames) { return contains(frames, above[i]); });
    if (carries_all) break;
    const ros::Time stamp = latest(buffer, above[i + 1], above[i]);
    if (!stamp.isZero() && (!oldest || stamp < oldest->stamp)) oldest = {above[i], stamp};
  }
  return oldest;
}

}  // namespace organ_collision
