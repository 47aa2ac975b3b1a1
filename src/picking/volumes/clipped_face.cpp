#include "clipped_face.hpp"

#include <cstddef>

namespace organ_collision {
namespace {

// [1] Rounding leaves corners of a polygon that were one this far from each other, as a share of
// their largest coordinate.
constexpr double kSameCorner = 1e-15;

void add_corner(const Eigen::Vector3d& corner, ConvexPolygon& polygon) {
  const auto is_same = [&](const Eigen::Vector3d& other) {
    return (corner - other).cwiseAbs().maxCoeff() <= kSameCorner * corner.cwiseAbs().maxCoeff();
  };
  if (polygon.empty() || !(is_same(polygon.back()) || is_same(polygon.front()))) {
    polygon.push_back(corner);
  }
}

/// Clips a convex polygon to a half-space: Sutherland and Hodgman, "Reentrant polygon clipping"
/// (1974).
ConvexPolygon clipped(const ConvexPolygon& polygon, const HalfSpace& half_space) {
  const auto height = [&](const Eigen::Vector3d& corner) {
    return half_space.normal.dot(corner) - half_space.offset;
  };
  ConvexPolygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& from = polygon[i];
    const Eigen::Vector3d& to = polygon[(i + 1) % polygon.size()];
    const double begin = height(from), end = height(to);
    if (begin <= 0.0) add_corner(from, inside);
    if ((begin < 0.0 && end > 0.0) || (begin > 0.0 && end < 0.0)) {
      add_corner(from + begin / (begin - end) * (to - from), inside);
    }
  }
  return inside;
}

}  // namespace

ConvexPolygon clipped(const Triangle& face, const ViewingVolume& volume) {
  ConvexPolygon polygon(face.begin(), face.end());
  for (std::size_t i = 0; i < volume.half_space_count() && !polygon.empty(); ++i) {
    polygon = clipped(polygon, volume.half_space(i));
  }
  return polygon;
}

}  // namespace organ_collision
