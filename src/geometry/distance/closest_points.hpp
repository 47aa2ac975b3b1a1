#pragma once

#include <Eigen/Core>
#include <limits>

#include "organ_collision/geometry/tool/convex_core.hpp"
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

}  // namespace organ_collision
