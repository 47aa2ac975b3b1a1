#include "organ_collision/geometry/convex_core.hpp"

namespace organ_collision {

using Eigen::Vector3d;

Vector3d ConvexCore::support(const Vector3d& direction) const {
  std::size_t farthest = 0;
  double height = direction.dot(points[0]);
  for (std::size_t i = 1; i < count; ++i) {
    const double other = direction.dot(points[i]);
    if (other > height) {
      height = other;
      farthest = i;
    }
  }
  if (disc_radius == 0.0) return points[farthest];
  // On the rim of the flat end: along what of the direction is across the axis.
  const Vector3d along = (points[1] - points[0]).normalized();
  const Vector3d across = direction - along.dot(direction) * along;
  return points[farthest] + disc_radius * across.stableNormalized();
}

double ConvexCore::height(const Vector3d& direction) const {
  return direction.dot(support(direction));
}

ConvexCore operator*(const Eigen::Isometry3d& T_to_from, const ConvexCore& core) {
  ConvexCore moved;
  moved.count = core.count;
  moved.disc_radius = core.disc_radius;
  for (std::size_t i = 0; i < core.count; ++i) moved.points[i] = T_to_from * core.points[i];
  return moved;
}

}  // namespace organ_collision
