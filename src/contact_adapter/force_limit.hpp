#pragma once

#include <geometry_msgs/Wrench.h>

namespace organ_collision {

/// If the force exceeds `max_force` [N], scales force and torque so that the force has this
/// magnitude. Returns whether it scaled them.
bool limit_force(geometry_msgs::Wrench& wrench, double max_force);

}  // namespace organ_collision
