#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/half_space.hpp"

namespace organ_collision::bench {

/// A bounded convex solid, given by its corners and sides.
struct ConvexSolid {
  std::vector<Eigen::Vector3d> corners;  ///< [m]
  std::vector<std::vector<int>>
      sides;  ///< indices of the corners of each side, anticlockwise seen from outside
};

/// The intersection of `half_spaces` [m], which must be bounded.
ConvexSolid solid_of(const std::vector<HalfSpace>& half_spaces);

}  // namespace organ_collision::bench
