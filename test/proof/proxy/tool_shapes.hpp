#pragma once

#include <vector>

#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision::oracle {

/// A convex part of a tool where it is now: all points within `radius` [m] of the core. A mesh has
/// one for each of its triangles.
struct PlacedCore {
  ConvexCore core;
  double radius;
};

/// The parts of a tool in this pose. As for the clearance, only shafts and balls have a radius.
std::vector<PlacedCore> placed_cores(const ProxyTool& tool, const ToolPose& pose);

/// The middle line of the shaft and of each part of each link, in this pose: what must not pass
/// through tissue. That of a link's part is a segment along the longest side of the box around it,
/// which ends half the shortest side before the ends of the box.
std::vector<ShaftAxis> skeleton(const ProxyTool& tool, const ToolPose& pose);

/// The pose in another frame.
ToolPose operator*(const Eigen::Isometry3d& T_to_from, const ToolPose& pose);

}  // namespace organ_collision::oracle
