#include "transform_lookup.hpp"

#include <tf2/exceptions.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "ros/interface/conversions.hpp"
#include "ros/interface/duration_text.hpp"
#include "ros/interface/plain_text.hpp"

namespace organ_collision {
namespace {

using NotFound = Lookup<Eigen::Isometry3d>;

bool contains(const std::vector<std::string>& frames, const std::string& frame) {
  return std::find(frames.begin(), frames.end(), frame) != frames.end();
}

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
  std::ostringstream text;
  text << "TF from '" << source << "' to '" << target << "' is "
       << duration_text(elapsed_sec(latest, time)) << " behind the stamp " << time;
  return {std::nullopt, text.str(), true};
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

std::optional<NewestTransform> oldest_transform(const tf2::BufferCore& buffer,
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
