#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// A box of any orientation [m].
struct OrientedBox {
  Eigen::Vector3d center;
  Eigen::Matrix3d axes;       ///< columns: orthonormal, right-handed
  Eigen::Vector3d half_size;  ///< along the axes; not negative
};

}  // namespace organ_collision
