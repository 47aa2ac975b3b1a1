#pragma once

#include <string>

#include "forces/forces.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "ros/parameters/node_parameters.hpp"

/// The names of haptic_proxy in the ROS graph, besides those of the collision node and of all nodes
/// with forces.
namespace organ_collision::names {

inline constexpr char kHapticProxy[] = "haptic_proxy";

///@{
/// A topic of a tool, below ~TOOL.
inline constexpr char kProxy[] = "proxy";
inline constexpr char kState[] = "state";
///@}

/// The proxy's TF frame is TOOL and this.
inline constexpr char kProxyFrame[] = "_proxy";

///@{
/// A parameter that messages name.
inline constexpr char kMaxTorque[] = "max_torque";
inline constexpr char kMeshTimeoutSec[] = "mesh_timeout_sec";
inline constexpr char kFrameTimeoutSec[] = "frame_timeout_sec";
///@}

}  // namespace organ_collision::names

namespace organ_collision {

/// The parameters of haptic_proxy, with the documented defaults. `markers` is without the depth.
struct HapticProxyParameters : OrganNodeParameters {
  std::string frame;               ///< the proxy's frame; empty: that of the first organ
  double stiffness = 300.0;        ///< [N/m] of the spring between hand and proxy
  double damping = 0.0;            ///< [N s/m] of the hand's velocity relative to the proxy's
  double max_force = kUnlimited;   ///< [N] larger forces are scaled down to it
  double max_torque = kUnlimited;  ///< [N m] of a free tool, about its centre; the same
  double clearance = ProxySettings().clearance;  ///< [m]
  double jump = ProxySettings().jump;            ///< [m]
  double puncture_force = 0.0;                   ///< [N] a needle pierces tissue at it; 0: never
  double friction = 0.0;                         ///< [N] along a needle that has pierced tissue
  double pose_timeout_sec = 0.1;
  double frame_timeout_sec = 0.5;  ///< of the organs' frames that are not static; 0: never stale
  bool publish_tf = true;
};

ParameterTable table_of(HapticProxyParameters& parameters);

/// How the proxy of a tool behaves: forces become lengths.
ProxySettings proxy_settings(const HapticProxyParameters& parameters, const ToolParameters& tool);

}  // namespace organ_collision
