#pragma once

#include <ros/time.h>

#include <string>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/organs/organ_registry.hpp"

namespace organ_collision {

/// The TF frame in which proxies move.
class ProxyFrame {
 public:
  /// `fixed`: the frame; empty: that of the first organ.
  explicit ProxyFrame(std::string fixed) : fixed_(!fixed.empty()), name_(std::move(fixed)) {}

  /// Empty: there was no organ yet.
  const std::string& name() const { return name_; }

  /// A frame that was chosen stays as long as an organ has it, or if no organ is left. Returns
  /// whether another frame was chosen.
  bool update(const OrganRegistry& organs);

 private:
  bool fixed_;
  std::string name_;
};

/// All organs as one tick of a proxy takes them.
struct ProxyScene {
  std::string frame;  ///< the proxy's
  std::vector<ProxyOrgan> organs;
  std::vector<const DeformableOrgan*> sources;  ///< of `organs`, in the same order
  /// The stamps of the organs' poses, in the same order; zero if an organ's frame is static.
  std::vector<ros::Time> stamps = {};
};

/// How old may be what is known of organs [s of ROS time]; 0: there is no limit.
struct AgeLimits {
  double mesh_sec = 0.0;   ///< their shapes, and their frames
  double frame_sec = 0.0;  ///< their frames, unless these are static
};

/// Why there is no answer without organs.
Rejection no_organ();

/// The organs with their latest shapes, at their latest poses in `frame`. They are valid as long as
/// the registry does not change. Throws Rejection if there is no answer with these organs: there is
/// none, one has no transform to the frame, or its shape or a transform is older than allowed.
ProxyScene proxy_scene(const OrganRegistry& organs, const TransformBuffer& transforms,
                       const std::string& frame, const AgeLimits& limits, ros::Time now);

/// Throws Rejection if the proxy's frame itself moves against the tool, and a transform of it is
/// older than allowed. `tool_frames`: those that determine the tool's pose; `stamp`: that of the
/// latest pose.
void check_age(const TransformBuffer& transforms, const std::string& frame,
               const TransformBuffer::Frames& tool_frames, ros::Time stamp, const AgeLimits& limits,
               ros::Time now);

}  // namespace organ_collision
