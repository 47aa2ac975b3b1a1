#pragma once

#include <Eigen/Core>

#include "organ_collision/geometry/shaft.hpp"
#include "organ_collision/geometry/triangle_mesh.hpp"

namespace organ_collision {

/// A nearest pair of an axis and a face.
struct ClosestPoints {
  double distance;              ///< [m] 0 where the axis pierces the face
  double shaft;                 ///< place on the axis, in [0, 1] from trocar to tip
  Eigen::Vector3d barycentric;  ///< of the point on the face, in the order of its corners
  Eigen::Vector3d on_axis;      ///< [m]
  Eigen::Vector3d on_face;      ///< [m]
};

/// The nearest points of an axis (possibly a single point) and a face (possibly degenerate to a
/// segment or a point). Of several pairs within tolerance::kTie, the one nearest the tip.
ClosestPoints closest_points(const ShaftAxis& axis, const Triangle& face);

}  // namespace organ_collision
