#pragma once

#include "forces/force_names.hpp"

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
