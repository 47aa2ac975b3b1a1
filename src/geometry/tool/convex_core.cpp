#include "organ_collision/geometry/tool/convex_core.hpp"

namespace organ_collision {

using Eigen::Vector3d;

Vector3d ConvexCore::support(const Vector3d& direction) const {
  std::size_t farthest = 0;
  double value = direction.dot(points[0]);
  for (std::size_t i = 1; i < count; ++i) {
    const double other = direction.dot(points[i]);
    if (other > value) {
      value = other;
      farthest = i;
    }
  }
  if (!is_cylinder()) return points[farthest];
  const Eigen::Vector2d across = rim.transpose() * direction;
  return points[farthest] + rim * across.stableNormalized();
}

double ConvexCore::support_value(const Vector3d& direction) const {
  return direction.dot(support(direction));
}

ConvexCore operator*(const Eigen::Isometry3d& T_to_from, const ConvexCore& core) {
  ConvexCore moved;
  moved.count = core.count;
  moved.rim = T_to_from.linear() * core.rim;
  for (std::size_t i = 0; i < core.count; ++i) moved.points[i] = T_to_from * core.points[i];
  return moved;
}

}  // namespace organ_collision
