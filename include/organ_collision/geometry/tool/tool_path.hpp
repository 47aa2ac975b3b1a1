#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// The pose of a tool at one time, in the organ's frame [m].
struct ToolPose {
  ShaftAxis axis;                             ///< the shaft's axis; unused if there is no shaft
  std::vector<Eigen::Isometry3d> links = {};  ///< T_organ_link of each link
  std::optional<Eigen::Vector3d> tip = {};  ///< the tip of a tool without a shaft, if it has a tip
};

/// The pose of a tool at `fraction` in [0, 1] of the step, in the organ's frame [m].
struct ToolWaypoint {
  double fraction;                            ///< the time, as a fraction of the step
  ShaftAxis axis;                             ///< the shaft's axis; unused if there is no shaft
  std::vector<Eigen::Isometry3d> links = {};  ///< T_organ_link of each link
  // How the tool came here from the waypoint before; unused in the first.
  ShaftArcs arcs = {};                   ///< of the ends of the axis
  std::vector<ChainMotion> joints = {};  ///< of each link, as long as `links`; or empty
};

/// How a tool moved during one step. From waypoint to waypoint, what is on a chain of joints moves
/// as these do. Otherwise, the ends of the shaft's axis and the origins of the links move linearly,
/// and the links turn about a fixed axis at constant speed (slerp). Fractions rise from 0 to 1. A
/// single waypoint is a tool at rest.
using ToolPath = std::vector<ToolWaypoint>;

/// The path of a tool at rest.
inline ToolPath resting_path(const ToolPose& pose) { return {{0.0, pose.axis, pose.links}}; }

}  // namespace organ_collision
