#pragma once

#include <geometry_msgs/Polygon.h>
#include <organ_collision/Clearance.h>
#include <organ_collision/Contact.h>
#include <organ_collision/Crossing.h>
#include <organ_collision/ToolMotion.h>
#include <organ_collision/ToolPlacement.h>

#include <Eigen/Geometry>

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/picking/region.hpp"
#include "organ_collision/query/clearance.hpp"
#include "organ_collision/query/contact.hpp"
#include "organ_collision/query/placement.hpp"

namespace organ_collision {

// Conversions between messages and the requests and results of CollisionQuery. All lengths are in
// metres.

// These copy all fields; the frame is the same.
Contact to_message(const FaceContact& contact);
Clearance to_message(const ToolClearance& clearance);
Crossing to_message(const AxisCrossing& crossing);
ToolPlacement to_message(const AxisPlacement& placement);
/// The corners in the same order and frame, rounded to 32-bit floats.
geometry_msgs::Polygon to_message(const Region& region);

/// The straight motion of a message, transformed into the target frame: two waypoints, or only the
/// last one if `at_end_only`.
ToolPath to_path(const ToolMotion& motion, bool at_end_only,
                 const Eigen::Isometry3d& T_target_source);

}  // namespace organ_collision
