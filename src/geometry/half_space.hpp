#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// All x with normal · x <= offset; `normal` points outward and is unit [m].
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset;
};

}  // namespace organ_collision
