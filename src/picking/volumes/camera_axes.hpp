#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// A camera's axes: orthonormal columns x, y, z. z is along `view` (not zero), and y points towards
/// the frame axis least aligned with it.
Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view);

/// The same with x along the part of `right` that is perpendicular to `view`. If `right` is
/// parallel to `view`, as above.
Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view, const Eigen::Vector3d& right);

}  // namespace organ_collision
