#pragma once

#include <Eigen/Core>

#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "separating_plane.hpp"

namespace organ_collision {

/// The space that a box of a link, grown by a radius, covers during one leg, in the organ's frame
/// [m]. See doc/theory/geometry.md, Swept boxes.
class SweptBox {
 public:
  /// `box` is in the link's frame; `radius` in metres.
  SweptBox(const OrientedBox& box, const RigidMotion& motion, double radius);

  /// The box's centre at the start of the leg.
  const Eigen::Vector3d& origin() const { return start_.center; }
  /// The axes of the box in the middle of the leg: columns, orthonormal, right-handed.
  const Eigen::Matrix3d& axes() const { return axes_; }
  /// The least and the greatest axis · point of the covered space, for each of axes().
  Eigen::Vector3d low() const { return start_.low.cwiseMin(end_.low).array() - reach_; }
  Eigen::Vector3d high() const { return start_.high.cwiseMax(end_.high).array() + reach_; }

  /// A time of the leg before which the face surely stays farther from the box than the radius
  /// minus `closer` [m]; above 1 if it does so during the whole leg. Tests planes with fixed
  /// normals: each of axes(), and the face's own normal at the start.
  double clear_until(const LegFace& face, double closer = 0.0) const;
  /// [m] A lower bound of the distance between the covered space and the face during the leg.
  double distance_bound(const FaceMotion& face) const;
  /// A box around the covered space.
  OrientedBox bounds() const;

 private:
  /// The box at one end of the leg.
  struct Place {
    Eigen::Vector3d center;
    Eigen::Matrix3d half_edges;  ///< columns: from the centre along the half edges
    Eigen::Vector3d low, high;   ///< ends of the projections onto `axes_`
  };
  Place place(const OrientedBox& box, const Eigen::Isometry3d& pose) const;

  Eigen::Matrix3d axes_;
  bool rests_;
  Place start_, end_;
  double reach_;  ///< [m] how far the box grows: radius plus chord deviation
};

/// A box around all positions of an axis during a leg. The first edge of the box is along the axis
/// in the middle of the leg, the second one along the motion of the tip. The box of an axis at rest
/// has no width.
OrientedBox box_around(const ShaftMotion& motion);

}  // namespace organ_collision
