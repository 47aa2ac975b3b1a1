#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// Orthonormal columns x, y, z with z along `view` (not zero) and y towards the frame axis least
/// aligned with it.
Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view);

/// The same with x along the part of `right` at right angles to `view`, where there is one.
Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view, const Eigen::Vector3d& right);

}  // namespace organ_collision
