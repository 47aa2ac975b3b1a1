#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// A box in any orientation [m].
struct OrientedBox {
  Eigen::Vector3d center;     ///< its middle
  Eigen::Matrix3d axes;       ///< columns: orthonormal, right-handed
  Eigen::Vector3d half_size;  ///< along the axes; not negative

  /// The greatest direction · point of the box's points. `direction` need not be unit.
  double support_value(const Eigen::Vector3d& direction) const {
    return direction.dot(center) + (direction.transpose() * axes).cwiseAbs() * half_size;
  }
};

}  // namespace organ_collision
