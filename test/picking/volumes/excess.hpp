#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// [m] The largest signed distance of a point (in the organ's frame) from the half-spaces of a
/// volume. Negative: the point is inside the volume.
inline double excess(const ViewingVolume& volume, const Eigen::Vector3d& point) {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    const HalfSpace half_space = volume.half_space(i);
    largest = std::max(largest, half_space.normal.dot(point - volume.origin()) - half_space.offset);
  }
  return largest;
}

}  // namespace organ_collision
