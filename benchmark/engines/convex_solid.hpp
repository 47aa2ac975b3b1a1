#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/half_space.hpp"

namespace organ_collision::bench {

/// A bounded convex solid by its corners and its sides.
struct ConvexSolid {
  std::vector<Eigen::Vector3d> corners;  ///< [m]
  std::vector<std::vector<int>> sides;   ///< corners of each, anticlockwise seen from outside
};

/// The solid that `half_spaces` bound [m].
ConvexSolid solid_of(const std::vector<HalfSpace>& half_spaces);

}  // namespace organ_collision::bench
