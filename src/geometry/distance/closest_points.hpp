#pragma once

#include <Eigen/Core>
#include <limits>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// A nearest pair of a tool's core and a face.
struct ClosestPoints {
  double distance;              ///< [m] 0 where the core meets the face
  double shaft;                 ///< place on an axis, in [0, 1] from trocar to tip; else 0
  Eigen::Vector3d barycentric;  ///< of the point on the face, in the order of its corners
  Eigen::Vector3d on_core;      ///< [m]
  Eigen::Vector3d on_face;      ///< [m]
  Eigen::Vector3d apart;        ///< [m] from core to face; far from the origin, more exact than
                                ///< the difference of the points
  int steps = 2;                ///< what finding it took, as WorkBudget counts
};

/// The nearest points of an axis (possibly a single point) and a face (possibly degenerate to a
/// segment or a point). Of several pairs within tolerance::kTie, the one nearest the tip.
ClosestPoints closest_points(const ShaftAxis& axis, const Triangle& face);

/// The nearest points of any core and a face. Of a hull of three and more points by Gilbert,
/// Johnson and Keerthi's iteration (1988), until no point can be nearer by 1e-12 m, or as much of
/// the distance, or rounding ends it: of boxes as thin as 1e-6 m up to 1e-7 m too far. For hulls,
/// `enough` [m] is enough: once the distance is surely larger, a lower bound above it is the
/// `distance`, and the points are any.
ClosestPoints closest_points(const ConvexCore& core, const Triangle& face,
                             double enough = std::numeric_limits<double>::infinity());

}  // namespace organ_collision
