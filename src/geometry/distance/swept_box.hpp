#pragma once

#include <Eigen/Core>

#include "geometry/organ/face_motion.hpp"
#include "geometry/tool/rigid_motion.hpp"
#include "organ_collision/geometry/tool/oriented_box.hpp"

namespace organ_collision {

/// The space that a box of a link, grown by a radius, covers during one leg, in the organ's frame
/// [m]. See doc/geometry.md, Swept boxes.
class SweptBox {
 public:
  /// `box` is in the link's frame; `radius` in metres.
  SweptBox(const OrientedBox& box, const RigidMotion& motion, double radius);

  /// The box's centre at the start of the leg.
  const Eigen::Vector3d& origin() const { return start_.center; }
  /// The axes of the box in the middle of the leg: columns, orthonormal, right-handed.
  const Eigen::Matrix3d& axes() const { return axes_; }
  /// Bounds of the covered space along each of axes(), as axis · point.
  Eigen::Vector3d low() const { return start_.low.cwiseMin(end_.low).array() - reach_; }
  Eigen::Vector3d high() const { return start_.high.cwiseMax(end_.high).array() + reach_; }

  /// [m] A lower bound of the distance between the covered space and the face during the leg.
  double distance_bound(const FaceMotion& face) const;
  /// A box around the covered space.
  OrientedBox bounds() const;

 private:
  /// The box at one end of the leg.
  struct Place {
    Eigen::Vector3d center;
    Eigen::Vector3d low, high;  ///< projections onto `axes_`
  };
  Place place(const OrientedBox& box, const Eigen::Isometry3d& pose) const;

  Eigen::Matrix3d axes_;
  Place start_, end_;
  double reach_;  ///< [m] radius plus chord deviation
};

}  // namespace organ_collision
