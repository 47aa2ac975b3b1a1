#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// A nearest pair of points of a tool's core and a face.
struct ClosestPoints {
  double distance;              ///< [m] 0 where the core meets the face
  double shaft;                 ///< place on an axis, in [0, 1] from trocar to tip; else 0
  Eigen::Vector3d barycentric;  ///< of `on_face`, in the order of the face's corners
  Eigen::Vector3d on_core;      ///< [m]
  Eigen::Vector3d on_face;      ///< [m]
  Eigen::Vector3d separation;   ///< [m] from core to face. Far from the origin it is more exact
                                ///< than the difference of the two points.
  int steps = 2;                ///< what the search cost, in steps of WorkBudget
};

/// The nearest points of a core and a face (possibly degenerate to a segment or a point). Each kind
/// of core has its own method: see axis_distance.hpp, cylinder_distance.hpp and gjk.hpp.
///
/// `distance_bound` [m] lets the search for a hull stop early. If the true distance is larger than
/// `distance_bound`, the returned distance may be any value between the two; the points are then
/// unspecified. Axes and cylinders ignore it.
ClosestPoints closest_points(const ConvexCore& core, const Triangle& face,
                             double distance_bound = std::numeric_limits<double>::infinity());

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

/// The nearest points of an axis (possibly a single point) and a face (possibly degenerate to a
/// segment or a point), in closed form. If several pairs are tied within tolerance::kTie, the
/// points are those nearest the tip. The distance is always the least one. See doc/geometry.md,
/// Ties and piercing.
ClosestPoints axis_closest_points(const ShaftAxis& axis, const Triangle& face);

}  // namespace organ_collision
