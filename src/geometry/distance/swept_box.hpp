#pragma once

#include <Eigen/Core>

#include "geometry/organ/face_motion.hpp"
#include "geometry/tool/rigid_motion.hpp"
#include "organ_collision/geometry/tool/oriented_box.hpp"

namespace organ_collision {

/// A box of a link, grown by a radius, on one leg of the link's way, in the organ's frame [m].
class SweptBox {
 public:
  /// `box` in the link's frame.
  SweptBox(const OrientedBox& box, const RigidMotion& motion, double radius);

  /// The box's centre at the start.
  const Eigen::Vector3d& origin() const { return start_.center; }
  /// The box's own axes half way: columns, orthonormal, right-handed.
  const Eigen::Matrix3d& axes() const { return axes_; }
  /// Of the whole leg, along the axes.
  Eigen::Vector3d low() const { return start_.low.cwiseMin(end_.low).array() - reach_; }
  Eigen::Vector3d high() const { return start_.high.cwiseMax(end_.high).array() + reach_; }

  /// A time of the leg before which the face surely stays farther from the box than the radius;
  /// above 1: all the time. Tried are planes that do not turn: across the box's axes half way, and
  /// along the face at the start. Since points move linearly but for their bend, the gap over such
  /// a plane is at least what lies between its values at both ends of the leg.
  double clear_until(const FaceMotion& face) const;

 private:
  struct Place {
    Eigen::Vector3d center;
    Eigen::Matrix3d half_edges;
    Eigen::Vector3d low, high;  ///< along the axes
  };
  Place place(const OrientedBox& box, const Eigen::Isometry3d& pose) const;

  Eigen::Matrix3d axes_;
  Place start_, end_;
  double reach_;  ///< [m] radius and bend
};

}  // namespace organ_collision
