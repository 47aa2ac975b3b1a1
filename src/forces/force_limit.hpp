#pragma once

#include <Eigen/Core>
#include <vector>

#include "face_force.hpp"

namespace organ_collision {

/// The factor in (0, 1] that reduces a force [N] or a torque [N m] to the magnitude `most` > 0, if
/// it is larger.
double share_within_limit(const Eigen::Vector3d& load, double most);

/// If the sum of the forces exceeds `max_force` [N], scales all of them so that their sum has this
/// magnitude. Returns whether it scaled them.
bool limit_force(std::vector<FaceForce>& forces, double max_force);

}  // namespace organ_collision
