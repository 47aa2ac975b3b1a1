#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "organ_collision/geometry/half_space.hpp"

namespace organ_collision::bench {

/// A bounded convex solid by its corners and its sides.
struct ConvexSolid {
  std::vector<Eigen::Vector3d> corners;  ///< [m]
  std::vector<std::vector<int>> sides;   ///< corners of each, anticlockwise seen from outside

  Eigen::AlignedBox3d box() const;
};

/// What `half_spaces` and `box` have in common [m].
ConvexSolid intersection(const std::vector<HalfSpace>& half_spaces, const Eigen::AlignedBox3d& box);

}  // namespace organ_collision::bench
