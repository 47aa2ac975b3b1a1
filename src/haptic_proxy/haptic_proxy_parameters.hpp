#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <limits>
#include <string>
#include <vector>

#include "forces/forces.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/parameters/live_parameters.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/parameters/program_help.hpp"
#include "ros/parameters/tool_parameters.hpp"

/// All names of haptic_proxy in the ROS graph, besides those of the collision node and of all nodes
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
/// A parameter.
inline constexpr char kFrame[] = "frame";
inline constexpr char kDamping[] = "damping";
inline constexpr char kMaxTorque[] = "max_torque";
inline constexpr char kClearance[] = "clearance";
inline constexpr char kJump[] = "jump";
inline constexpr char kPunctureForce[] = "puncture_force";
inline constexpr char kFriction[] = "friction";
inline constexpr char kPoseTimeoutSec[] = "pose_timeout_sec";
inline constexpr char kFrameTimeoutSec[] = "frame_timeout_sec";
inline constexpr char kPublishTf[] = "publish_tf";
///@}

}  // namespace organ_collision::names

namespace organ_collision {

/// The parameters that can be changed while the node runs, with the documented defaults.
struct LiveHapticProxyParameters {
  double stiffness = 300.0;  ///< [N/m] of the spring between hand and proxy
  double damping = 0.0;      ///< [N s/m] of the hand's velocity relative to the proxy's
  double max_force =
      std::numeric_limits<double>::infinity();  ///< [N] larger forces are scaled down to it
  /// [N m] of a free tool, about its centre; larger torques are scaled down to it
  double max_torque = std::numeric_limits<double>::infinity();
  double clearance = ProxySettings().clearance;  ///< [m]
  double jump = ProxySettings().jump;            ///< [m]
  double puncture_force = 0.0;                   ///< [N] a needle pierces tissue at it; 0: never
  double friction = 0.0;                         ///< [N] along a needle that has pierced tissue
  MarkerSettings markers;                        ///< without the depth
};

/// The validated parameters of the node, with the documented defaults.
struct HapticProxyParameters : LiveHapticProxyParameters {
  std::vector<ToolParameters> tools;
  std::string frame;  ///< the proxy's frame; empty: that of the first organ
  double pose_timeout_sec = 0.1;
  double mesh_timeout_sec = 0.0;   ///< 0: never stale
  double frame_timeout_sec = 0.5;  ///< of the organs' frames that are not static; 0: never stale
  PickerSettings picker;
  double max_ahead_sec = kMaxAheadDefault;
  int max_faces = kMaxFacesDefault;
  double diagnostic_period_sec = 1.0;  ///< of wall time
  RealtimeParameters realtime;
  bool publish_tf = true;
};

/// The parameters, and one sentence for each unknown name among them.
struct LoadedHapticProxyParameters {
  HapticProxyParameters parameters;
  std::vector<std::string> misspelt;
};

/// From the value of the node's private namespace. Throws ParameterError.
LoadedHapticProxyParameters parse_haptic_proxy_parameters(
    const XmlRpc::XmlRpcValue& private_namespace);
/// From the parameter server. Throws ParameterError.
LoadedHapticProxyParameters load_haptic_proxy_parameters(const ros::NodeHandle& private_node);

/// The members of LiveHapticProxyParameters, for LiveParameters.
std::vector<LiveParameter> live_parameters(const LiveHapticProxyParameters& parameters);

/// The parameters after these changes. Throws ParameterError if a change is illegal, or if the
/// parameter cannot be changed while the node runs.
LiveHapticProxyParameters changed(const LiveHapticProxyParameters& parameters,
                                  const XmlRpc::XmlRpcValue& changes);

/// How the proxy of a tool behaves: forces become lengths.
ProxySettings proxy_settings(const LiveHapticProxyParameters& parameters,
                             const ToolParameters& tool);

/// What --help of haptic_proxy says. doc/haptic_interface.md explains the same names at length; a
/// test compares both.
ProgramHelp haptic_proxy_help();

}  // namespace organ_collision
