#pragma once

#include <vector>

#include "face_force.hpp"

namespace organ_collision {

/// If the sum of the forces exceeds `max_force` [N], scales all of them so that their sum has this
/// magnitude. Returns whether it scaled them.
bool limit_force(std::vector<FaceForce>& forces, double max_force);

}  // namespace organ_collision
