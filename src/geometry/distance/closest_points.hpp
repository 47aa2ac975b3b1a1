#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// A pair of nearest points of a tool's core and a face.
struct ClosestPoints {
  double distance;              ///< [m] 0 if the core meets the face
  double shaft;                 ///< place on an axis, in [0, 1] from trocar to tip; otherwise 0
  Eigen::Vector3d barycentric;  ///< barycentric coordinates of `on_face`
  Eigen::Vector3d on_core;      ///< [m] the nearest point of the core
  Eigen::Vector3d on_face;      ///< [m] the nearest point of the face
  Eigen::Vector3d separation;   ///< [m] vector from core to face; far from the origin it is more
                                ///< exact than the difference of the two points
  int steps = 2;                ///< what the search cost, in steps of WorkBudget
};

/// The nearest points of a core and a face (possibly degenerate to a segment or a point). The
/// method depends on the kind of core.
///
/// `distance_bound` [m] lets the search for a hull stop early. If the true distance is larger than
/// the bound, the returned distance may be any value between the bound and the true distance, and
/// the points are unspecified. Axes and cylinders ignore the bound.
ClosestPoints closest_points(const ConvexCore& core, const Triangle& face,
                             double distance_bound = std::numeric_limits<double>::infinity());

/// The nearest points of an axis (possibly a single point) and a face (possibly degenerate to a
/// segment or a point), in closed form. If several pairs are tied within tolerance::kTie, the pair
/// nearest to the tip is returned. The distance is always the least distance of all pairs. See
/// doc/theory/geometry.md, Ties and piercing.
ClosestPoints axis_closest_points(const ShaftAxis& axis, const Triangle& face);

/// The nearest points of a hull of three or more points and a face (possibly degenerate), by the
/// iteration of Gilbert, Johnson and Keerthi (1988). `distance_bound` [m] is as for
/// closest_points().
///
/// The iteration ends when no pair can be nearer by more than 1e-12 m (or 1e-12 of the distance),
/// or when rounding prevents progress. Rounding makes the distance up to 1e-7 m too large for boxes
/// as thin as 1e-6 m. The distance is never too small, except for rounding. See
/// doc/theory/geometry.md, Distance algorithms.
ClosestPoints gjk_closest_points(const ConvexCore& hull, const Triangle& face,
                                 double distance_bound);

/// The barycentric coordinates of the origin's projection onto the plane of the triangle a, b, c
/// [m]. `area` is the twice_area() of the triangle. Nothing if the projection lies outside the
/// triangle or the triangle is degenerate. To project another point, pass the corners relative to
/// that point. Source: Ericson, Real-Time Collision Detection, 3.4.
inline std::optional<Eigen::Vector3d> project_origin(const Eigen::Vector3d& a,
                                                     const Eigen::Vector3d& b,
                                                     const Eigen::Vector3d& c,
                                                     const Eigen::Vector3d& area) {
  const Eigen::Vector3d areas(area.dot(b.cross(c)), area.dot(c.cross(a)), area.dot(a.cross(b)));
  if (!(areas.minCoeff() >= 0.0) || !(areas.sum() > 0.0)) return std::nullopt;
  return areas / areas.sum();
}

}  // namespace organ_collision
