#pragma once

#include <Eigen/Geometry>

namespace organ_collision {

/// The smallest rotation that turns the direction of one vector into that of another. Neither may
/// be zero. It is compiled here alone, because Eigen's function brings a singular value
/// decomposition into each source that calls it.
Eigen::Quaterniond least_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace organ_collision
