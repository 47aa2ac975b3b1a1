#pragma once

#include <geometry_msgs/Wrench.h>

namespace organ_collision {

/// Scales a wrench whose force exceeds `max_force` [N] down to it, its torque with it. Returns
/// whether it did.
bool limit_force(geometry_msgs::Wrench& wrench, double max_force);

}  // namespace organ_collision
