#pragma once

#include <Eigen/Core>
#include <cmath>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {

/// Whether a coordinate [m] is finite and its absolute value at most tolerance::kFarthest.
inline bool is_in_range(double coordinate) {
  return std::abs(coordinate) <= tolerance::kFarthest;  // false for NaN
}

/// Whether all coordinates of a point [m] are finite and within tolerance::kFarthest.
inline bool is_in_range(const Eigen::Vector3d& point) {
  return (point.array().abs() <= tolerance::kFarthest).all();
}

}  // namespace organ_collision
