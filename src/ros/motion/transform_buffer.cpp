#include "transform_buffer.hpp"

#include <algorithm>

#include "ros/interface/clock_rules.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

/// [parents] A frame rarely changes its parent, for example when an instrument is handed over.
constexpr std::size_t kMostParents = 8;

bool contains(const std::vector<std::size_t>& frames, std::size_t frame) {
  return std::find(frames.begin(), frames.end(), frame) != frames.end();
}

void insert(std::vector<std::size_t>& frames, std::size_t frame) {
  if (!contains(frames, frame)) frames.push_back(frame);
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
    if (stamp <= frame.answered && !frame.stamps.contains(stamp)) ++late_;
  }
  if (!taken) return false;
  const std::size_t parent = index_of(tf_frame(transform.header.frame_id));
  Frame& frame = frames_[index_of(tf_frame(transform.child_frame_id))];
  if (!resting) {
    judge(frame, stamp);
    frame.stamps.add(stamp);
    latest_ = std::max(latest_, stamp);
  }
  insert(frame.parents, parent);
  if (frame.parents.size() > kMostParents) frame.parents.erase(frame.parents.begin());
  return true;
}

/// Finds out whether a new stamp of the frame disproves an earlier one, or reaches the one that was
/// disproved.
void TransformBuffer::judge(Frame& frame, ros::Time stamp) {
  const ros::Time latest = frame.stamps.latest();
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

bool TransformBuffer::has(const std::string& frame, ros::Time stamp) const {
  const auto known = indices_.find(tf_frame(frame));
  return known != indices_.end() && frames_[known->second].stamps.contains(stamp);
}

void TransformBuffer::clear() {
  BufferCore::clear();
  for (Frame& frame : frames_) {
    frame.stamps.clear();
    frame.answered = frame.disproved = ros::Time();
  }
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
    const ros::Time heard = frames_[frame].stamps.heard();
    until = until ? std::min(*until, heard) : heard;
  }
  return until;
}

ros::Time TransformBuffer::forgotten(const std::string& target, const Frames& sources) const {
  ros::Time latest;
  for (const std::size_t frame : chain(target, sources)) {
    latest = std::max(latest, frames_[frame].stamps.forgotten());
  }
  return latest;
}

bool TransformBuffer::has_heard(const std::string& frame) const {
  const auto known = indices_.find(frame);
  return known != indices_.end() && !frames_[known->second].stamps.empty();
}

std::vector<ros::Time> TransformBuffer::stamps_between(const std::string& target,
                                                       const Frames& sources, ros::Time from,
                                                       ros::Time to) const {
  std::vector<ros::Time> stamps;
  if (to <= from) return stamps;
  for (const std::size_t frame : chain(target, sources)) {
    frames_[frame].stamps.append_between(from, to, stamps);
  }
  std::sort(stamps.begin(), stamps.end());
  stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
  return stamps;
}

void TransformBuffer::set_answered(const std::string& target, const Frames& sources,
                                   ros::Time stamp) {
  for (const std::size_t frame : chain(target, sources)) {
    frames_[frame].answered = std::max(frames_[frame].answered, stamp);
  }
}

std::size_t TransformBuffer::index_of(const std::string& frame) {
  const auto [known, is_new] = indices_.try_emplace(frame, frames_.size());
  if (is_new) {
    frames_.push_back({StampRecord(getCacheLength()), {}, {}, {}});
  }
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
  if (const auto known = indices_.find(frame); known != indices_.end())
    insert(found, known->second);
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

}  // namespace organ_collision
