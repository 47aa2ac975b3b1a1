#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace organ_collision {

/// Up to four corners in the plane, counterclockwise. No corner lies inside an edge.
struct ConvexHull {
  std::array<Eigen::Vector2d, 4> corners;
  std::size_t count = 0;

  const Eigen::Vector2d* begin() const { return corners.data(); }
  const Eigen::Vector2d* end() const { return corners.data() + count; }
};

/// The convex hull of four points: one corner if all coincide, two if they lie on a line. Allocates
/// nothing.
ConvexHull convex_hull(std::array<Eigen::Vector2d, 4> points);

}  // namespace organ_collision
