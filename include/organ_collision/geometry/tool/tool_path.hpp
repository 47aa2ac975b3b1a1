#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// Where a rigid body is that carries an end of a shaft's axis, in the organ's frame.
struct EndCarrier {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< of the body
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();  ///< [m] from the body's origin to the end

  /// How the end moves if the body moves from here to `next`, turning by the shortest way.
  ShaftArc arc_to(const EndCarrier& next) const;
};

/// The pose of a tool at one time, in the organ's frame [m].
struct ToolPose {
  ShaftAxis axis;                             ///< the shaft's axis; unused if there is no shaft
  std::vector<Eigen::Isometry3d> links = {};  ///< T_organ_link of each link
  std::optional<Eigen::Vector3d> tip = {};  ///< the tip of a tool without a shaft, if it has a tip
  std::array<EndCarrier, 2> carriers = {};  ///< what carries trocar and tip, for PathBuilder
};

/// The pose of a tool at `fraction` in [0, 1] of the step, in the organ's frame [m].
struct ToolWaypoint {
  double fraction;                            ///< the time, as a fraction of the step
  ShaftAxis axis;                             ///< the shaft's axis; unused if there is no shaft
  std::vector<Eigen::Isometry3d> links = {};  ///< T_organ_link of each link
  ShaftArcs arcs = {};  ///< how the axis came here from the waypoint before; unused in the first
};

/// How a tool moved during one step. From waypoint to waypoint the ends of the shaft's axis move
/// linearly or on arcs, the origins of the links move linearly, and the links turn about a fixed
/// axis at constant speed (slerp). Fractions rise from 0 to 1. A single waypoint is a tool at rest.
using ToolPath = std::vector<ToolWaypoint>;

/// The path of a tool at rest.
inline ToolPath resting_path(const ToolPose& pose) { return {{0.0, pose.axis, pose.links}}; }

}  // namespace organ_collision
