#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// All points x with normal · x <= offset [m]. `normal` is unit and points outward.
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset;
};

}  // namespace organ_collision
