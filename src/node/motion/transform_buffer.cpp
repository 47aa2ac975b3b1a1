#include "transform_buffer.hpp"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "common/messages/conversions.hpp"
#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"

namespace organ_collision {

namespace {

/// [parents] How many recent parents of a frame are kept. A frame rarely changes its parent, for
/// example when an instrument is handed over.
constexpr std::size_t kMostParents = 8;
/// [stamps] How many stamps of a frame are kept: those of the 10 s that TF keeps, at 1 kHz.
constexpr std::size_t kMostStamps = 10'000;

template <typename Frame>
bool contains(const std::vector<Frame>& frames, Frame frame) {
  return std::find(frames.begin(), frames.end(), frame) != frames.end();
}

template <typename Frame>
void insert(std::vector<Frame>& frames, Frame frame) {
  if (!contains(frames, frame)) frames.push_back(frame);
}

/// Whether tf2 would not keep a transform with this stamp beside those with the rising `stamps`.
bool is_too_old(ros::Time stamp, const std::deque<ros::Time>& stamps, ros::Duration kept) {
  return !stamps.empty() && stamp < stamps.back() &&
         stamps.back().toNSec() - stamp.toNSec() > static_cast<std::uint64_t>(kept.toNSec());
}

using NotFound = Lookup<Eigen::Isometry3d>;

NotFound late(const std::string& target, const std::string& source, ros::Time latest,
              ros::Time time) {
  const std::string behind = duration_text(seconds_between(latest, time));
  return {std::nullopt,
          concatenate("TF from '", source, "' to '", target, "' is ", behind, " behind the stamp ",
                      time),
          true};
}

/// Says why TF has no transform at `time`. `error`: what tf2 threw.
NotFound not_found(const tf2::BufferCore& buffer, const std::string& target,
                   const std::string& source, ros::Time time, const std::runtime_error& error) {
  for (const std::string& frame : {source, target}) {
    if (buffer._frameExists(frame)) continue;
    return {std::nullopt, "frame '" + frame + "' is unknown to TF", false, frame};
  }
  if (dynamic_cast<const tf2::ConnectivityException*>(&error) != nullptr) {
    return {std::nullopt, "frame '" + source + "' is not connected to '" + target + "' on TF"};
  }
  // tf2 cannot say that it would have to extrapolate by more than 2^31 s, so that the type of the
  // error does not count.
  if (buffer.canTransform(target, source, ros::Time(0))) {
    const ros::Time newest = buffer.lookupTransform(target, source, ros::Time(0)).header.stamp;
    if (!newest.isZero() && newest < time) return late(target, source, newest, time);
  }
  // The text of tf2 may be long: for a loop of frames, it lists all frames.
  return {std::nullopt, "no transform from " + source + " to " + target + ": " +
                            plain_text(error.what(), kLongestMessage)};
}

}  // namespace

bool TransformBuffer::add(const geometry_msgs::TransformStamped& transform,
                          const std::string& authority, bool resting) {
  const ros::Time stamp = transform.header.stamp;
  const std::string name = tf_frame(transform.child_frame_id);
  const Frame* const known = find(name);
  if (!resting && known) {
    // tf2 would log each of them. A repeated transform is not late.
    if (has(name, stamp)) return false;
    if (stamp <= known->answered) frames_[name].late = ++late_;
    if (is_too_old(stamp, known->stamps, getCacheLength())) return false;
  }
  if (!setTransform(transform, authority, resting)) return false;
  const std::string parent_name = tf_frame(transform.header.frame_id);
  Frame &frame = frames_[name], &parent = frames_[parent_name];
  frame.name = name;
  parent.name = parent_name;
  if (!resting) {
    note(frame, stamp);
    latest_ = std::max(latest_, stamp);
  }
  frame.parents.erase(std::remove(frame.parents.begin(), frame.parents.end(), &parent),
                      frame.parents.end());
  frame.parents.push_back(&parent);
  if (frame.parents.size() > kMostParents) frame.parents.erase(frame.parents.begin());
  return true;
}

/// Records a stamp. A stamp is forgotten when TF forgets its transform, or when there are too many.
void TransformBuffer::note(Frame& frame, ros::Time stamp) {
  std::deque<ros::Time>& stamps = frame.stamps;
  const ros::Time now = ros::Time::now();
  frame.received = now.isZero() ? stamp : now;  // Before the first /clock, only the stamp tells.
  if (stamps.empty() || stamp > stamps.back()) frame.advanced = frame.received;
  stamps.insert(std::upper_bound(stamps.begin(), stamps.end(), stamp), stamp);
  // In whole nanoseconds, because the arithmetic of ros::Time throws for extreme stamps.
  const std::uint64_t latest = stamps.back().toNSec();
  const auto kept = static_cast<std::uint64_t>(getCacheLength().toNSec());
  while (stamps.size() > kMostStamps || latest - stamps.front().toNSec() > kept) {
    frame.forgotten = std::max(frame.forgotten, stamps.front());
    stamps.pop_front();
  }
}

bool TransformBuffer::has(const std::string& frame, ros::Time stamp) const {
  const Frame* const known = find(tf_frame(frame));
  return known && std::binary_search(known->stamps.begin(), known->stamps.end(), stamp);
}

void TransformBuffer::clear() {
  BufferCore::clear();
  for (auto& [name, frame] : frames_) frame = {name, std::move(frame.parents)};
  latest_ = ros::Time();
}

bool TransformBuffer::goes_on(const std::string& target, const Frames& sources, ros::Time time,
                              ros::Time now) const {
  const Nodes frames = chain(target, sources);
  return std::all_of(frames.begin(), frames.end(), [&](const Frame* frame) {
    const std::deque<ros::Time>& stamps = frame->stamps;
    if (stamps.empty() || stamps.back() > time) return true;
    // Senders without a clock of their own may give several transforms almost the same stamp.
    const auto before = std::find_if(std::next(stamps.rbegin()), stamps.rend(), [&](auto stamp) {
      return seconds_between(stamp, stamps.back()) >= kVelocitySec;
    });
    const ros::Time since = before == stamps.rend() ? stamps.front() : *before;
    return organ_collision::goes_on(seconds_between(since, stamps.back()), frame->advanced, now);
  });
}

bool TransformBuffer::has_heard(const std::string& frame) const {
  const Frame* const known = find(frame);
  return known && !known->stamps.empty();
}

FrameJoints TransformBuffer::joints(const std::string& target, const std::string& frame,
                                    ros::Time time) const {
  Nodes above_target = upward_at(target, time), above_frame = upward_at(frame, time);
  std::string common = target;
  while (!above_target.empty() && !above_frame.empty() &&
         above_target.back() == above_frame.back()) {
    common = above_frame.back()->name;
    above_target.pop_back();
    above_frame.pop_back();
  }
  FrameJoints joints;
  std::string last = target;
  const auto go_to = [&](const std::string& next) {
    if (last == next) return;
    const auto pose = look_up(*this, last, next, time);
    if (!pose.found) throw std::runtime_error(pose.why_not);
    joints.poses.push_back(pose.found->value);
    last = next;
  };
  const auto moves = [](const Frame* above) { return !above->stamps.empty(); };
  // The inverse of a joint turns first, and then its origin moves linearly.
  const auto turn_first = [&] {
    Eigen::Isometry3d& inverse = joints.poses.back();
    const Eigen::Vector3d origin = inverse.linear().transpose() * inverse.translation();
    inverse.translation().setZero();
    joints.poses.emplace_back(Eigen::Translation3d(origin));
  };
  try {
    for (const Frame* const above : above_target) {
      if (!moves(above)) continue;
      // Up to the frame that moves, all is static. From there to the next one, its joint moves.
      go_to(above->name);
      joints.way.push_back(above);
      const auto next = std::find_if(std::find(above_target.begin(), above_target.end(), above) + 1,
                                     above_target.end(), moves);
      go_to(next == above_target.end() ? common : (*next)->name);
      turn_first();
    }
    go_to(common);
    joints.way.push_back(nullptr);
    for (auto above = above_frame.rbegin(); above != above_frame.rend(); ++above) {
      if (!moves(*above)) continue;
      go_to((*above)->name);
      joints.way.push_back(*above);
    }
    go_to(frame);
  } catch (const std::runtime_error&) {
    return {};
  }
  return joints;
}

TransformBuffer::Stamps TransformBuffer::stamps_between(const std::string& target,
                                                        const Frames& sources, ros::Time from,
                                                        ros::Time to) const {
  Stamps found;
  std::vector<ros::Time>& rising = found.rising;
  for (const Frame* const frame : chain(target, sources)) {
    found.forgotten = std::max(found.forgotten, frame->forgotten);
    if (to <= from) continue;
    const auto begin = std::upper_bound(frame->stamps.begin(), frame->stamps.end(), from);
    rising.insert(rising.end(), begin, std::lower_bound(begin, frame->stamps.end(), to));
  }
  std::sort(rising.begin(), rising.end());
  rising.erase(std::unique(rising.begin(), rising.end()), rising.end());
  return found;
}

void TransformBuffer::set_answered(const std::string& target, const Frames& sources,
                                   ros::Time stamp) {
  for (const Frame* const frame : chain(target, sources)) {
    frames_.at(frame->name).answered = std::max(frame->answered, stamp);
  }
}

std::string TransformBuffer::late_frame(const std::string& target, const Frames& sources,
                                        std::size_t seen) const {
  if (seen == late_) return "";
  const Nodes frames = chain(target, sources);
  const auto late = std::find_if(frames.begin(), frames.end(),
                                 [seen](const Frame* frame) { return frame->late > seen; });
  return late == frames.end() ? "" : (*late)->name;
}

std::optional<LastTransform> TransformBuffer::oldest_transform(const std::string& frame,
                                                               const Frames& others) const {
  std::vector<Nodes> above_others;
  for (const std::string& other : others) above_others.push_back(upward(other, 1));
  std::optional<LastTransform> oldest;
  for (const Frame* const above : upward(frame, 1)) {
    const bool carries_all =
        std::all_of(above_others.begin(), above_others.end(),
                    [&](const Nodes& frames) { return contains(frames, above); });
    if (carries_all) break;
    if (above->stamps.empty()) continue;
    if (!oldest || above->received < oldest->received) oldest = {above->name, above->received};
  }
  return oldest;
}

/// The record of a frame. Null if no transform of the frame came, nor of a frame below it.
const TransformBuffer::Frame* TransformBuffer::find(const std::string& frame) const {
  const auto known = frames_.find(frame);
  return known == frames_.end() ? nullptr : &known->second;
}

/// The frames whose transforms determine the poses of `sources` in the target frame. If one of
/// these frames changed its parent recently, further frames above it may be included.
TransformBuffer::Nodes TransformBuffer::chain(const std::string& target,
                                              const Frames& sources) const {
  const Nodes above_target = upward(target, kMostParents);
  Nodes found;
  for (const std::string& source : sources) {
    const Nodes above_source = upward(source, kMostParents);
    Nodes all = above_source;
    for (const Frame* const frame : above_target) insert(all, frame);
    const bool is_tree = std::all_of(all.begin(), all.end(),
                                     [](const Frame* frame) { return frame->parents.size() <= 1; });
    for (const Frame* const frame : all) {
      const bool is_above_both = contains(above_source, frame) && contains(above_target, frame);
      if (!is_tree || !is_above_both) insert(found, frame);
    }
  }
  return found;
}

/// The frame and all its ancestors, each once, through at most `most` recent parents of each frame.
TransformBuffer::Nodes TransformBuffer::upward(const std::string& frame, std::size_t most) const {
  Nodes found;
  if (const Frame* const known = find(frame)) found = {known};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Nodes& parents = found[i]->parents;
    const std::size_t first = parents.size() - std::min(most, parents.size());
    for (std::size_t k = first; k < parents.size(); ++k) insert(found, parents[k]);
  }
  return found;
}

/// The frame and all its ancestors at a time.
TransformBuffer::Nodes TransformBuffer::upward_at(const std::string& frame, ros::Time time) const {
  Nodes found;
  for (const Frame* above = find(frame); above && !contains(found, above);) {
    found.push_back(above);
    const Nodes& parents = above->parents;
    std::string parent = parents.empty() ? "" : parents.back()->name;
    if (parents.size() > 1 && !_getParent(above->name, time, parent)) break;
    above = find(parent);
  }
  return found;
}

Lookup<Eigen::Isometry3d> look_up(const TransformBuffer& buffer, const std::string& target,
                                  const std::string& source, ros::Time time) {
  if (target == source) return {{{Eigen::Isometry3d::Identity(), time}}, ""};
  try {
    const geometry_msgs::TransformStamped found = buffer.lookupTransform(target, source, time);
    const Eigen::Isometry3d T_target_source = to_eigen(found.transform);
    if (!T_target_source.matrix().allFinite()) {
      return {std::nullopt, "transform from " + source + " to " + target + " is not finite"};
    }
    return {{{T_target_source, time.isZero() ? found.header.stamp : time}}, ""};
  } catch (const std::runtime_error& error) {  // From tf2, or from ros::Time for extreme stamps.
    return not_found(buffer, target, source, time, error);
  }
}

}  // namespace organ_collision
