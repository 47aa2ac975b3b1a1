#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// A box in any orientation [m].
struct OrientedBox {
  Eigen::Vector3d center;     ///< the middle of the box
  Eigen::Matrix3d axes;       ///< directions of the edges: orthonormal columns, right-handed
  Eigen::Vector3d half_size;  ///< half of the edge lengths along `axes`; not negative

  /// The greatest direction · point of the box. `direction` need not be a unit vector.
  double support_value(const Eigen::Vector3d& direction) const {
    return direction.dot(center) + (direction.transpose() * axes).cwiseAbs() * half_size;
  }
};

}  // namespace organ_collision
