#include "organ_collision/geometry/tool/link.hpp"

#include <utility>

#include "organ_collision/geometry/tolerances.hpp"

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

LinkPart LinkPart::sphere(const Vector3d& center, double radius) {
  LinkPart part{{}, nullptr, radius, {center, Eigen::Matrix3d::Identity(), Vector3d::Zero()}};
  part.core.count = 1;
  part.core.points[0] = center;
  return part;
}

LinkPart LinkPart::cylinder(const Eigen::Isometry3d& T_link_shape, double radius, double length) {
  const Vector3d end = {0.0, 0.0, 0.5 * length};
  LinkPart part{ShaftAxis{T_link_shape * Vector3d(-end), T_link_shape * end},
                nullptr,
                tolerance::kConvexMargin,
                {T_link_shape.translation(), T_link_shape.linear(), {radius, radius, end.z()}}};
  part.core.rim = radius * T_link_shape.linear().leftCols<2>();
  return part;
}

LinkPart LinkPart::box(const Eigen::Isometry3d& T_link_shape, const Vector3d& size) {
  LinkPart part{{},
                nullptr,
                tolerance::kConvexMargin,
                {T_link_shape.translation(), T_link_shape.linear(), 0.5 * size}};
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {-0.5, 0.5}) {
        part.core.points[part.core.count++] = T_link_shape * size.cwiseProduct(Vector3d(x, y, z));
      }
    }
  }
  return part;
}

LinkPart LinkPart::mesh(ToolSurface surface) {
  auto shared = std::make_shared<const ToolSurface>(std::move(surface));
  const OrientedBox& bounds = shared->nodes().front().box;
  return {{}, shared, tolerance::kConvexMargin, bounds};
}

ProjectionInterval LinkPart::project_onto(const Vector3d& direction) const {
  if (surface) return surface->project_onto(direction);
  return {-core.support_value(-direction), core.support_value(direction)};
}

}  // namespace organ_collision
