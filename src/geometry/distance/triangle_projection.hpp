#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace organ_collision {

/// Barycentric coordinates of the origin's projection onto the plane of the triangle a, b, c [m],
/// whose twice_area() is `area`. None if the projection lies outside the triangle or the triangle
/// is degenerate. For another point, pass the corners relative to it. Source: Ericson, Real-Time
/// Collision Detection, 3.4.
inline std::optional<Eigen::Vector3d> project_origin(const Eigen::Vector3d& a,
                                                     const Eigen::Vector3d& b,
                                                     const Eigen::Vector3d& c,
                                                     const Eigen::Vector3d& area) {
  const Eigen::Vector3d areas(area.dot(b.cross(c)), area.dot(c.cross(a)), area.dot(a.cross(b)));
  if (!(areas.minCoeff() >= 0.0) || !(areas.sum() > 0.0)) return std::nullopt;
  return areas / areas.sum();
}

}  // namespace organ_collision
