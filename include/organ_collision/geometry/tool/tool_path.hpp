#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// Where a tool was at one time, in the organ's frame [m].
struct ToolPose {
  ShaftAxis axis;                             ///< of its shaft; means nothing where it has none
  std::vector<Eigen::Isometry3d> links = {};  ///< T_organ_link of each of its links
};

/// The same at `fraction` in [0, 1] of the step.
struct ToolWaypoint {
  double fraction;
  ShaftAxis axis;                             ///< of its shaft; means nothing where it has none
  std::vector<Eigen::Isometry3d> links = {};  ///< T_organ_link of each of its links
};

/// How a tool moved during one step: from waypoint to waypoint, ends of the axis linearly, links as
/// RigidMotion says, with fractions rising from 0 to 1. A single waypoint is a tool at rest.
using ToolPath = std::vector<ToolWaypoint>;

/// The path of a tool at rest.
inline ToolPath resting_path(const ToolPose& pose) { return {{0.0, pose.axis, pose.links}}; }

}  // namespace organ_collision
