#pragma once

#include <ros/time.h>

#include <string>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "ros/interface/rejection.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/organs/organ_registry.hpp"

namespace organ_collision {

/// All organs as one tick of a proxy takes them.
struct ProxyScene {
  std::string frame;  ///< the proxy's
  std::vector<ProxyOrgan> organs;
  std::vector<const DeformableOrgan*> sources;  ///< of `organs`, in the same order
};

/// Why there is no answer without organs.
Rejection no_organ();

/// The organs with their latest shapes, at their latest poses in `frame`. They are valid as long as
/// the registry does not change. Throws Rejection if there is no answer with these organs: there is
/// none, one has no transform to the frame, or one is older than `mesh_timeout_sec` (0: never).
ProxyScene proxy_scene(const OrganRegistry& organs, const TransformBuffer& transforms,
                       const std::string& frame, double mesh_timeout_sec, ros::Time now);

}  // namespace organ_collision
