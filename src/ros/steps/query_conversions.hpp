#pragma once

#include <geometry_msgs/Polygon.h>
#include <organ_collision/Clearance.h>
#include <organ_collision/Contact.h>
#include <organ_collision/Crossing.h>
#include <organ_collision/ToolPlacement.h>

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

}  // namespace organ_collision
