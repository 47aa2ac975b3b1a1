#pragma once

#include <Eigen/Core>

#include "geometry/organ/organ_motion.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tool/oriented_box.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// A face during one leg, with what many tests of it share [m]. It refers to the face's motion,
/// which must outlive it.
struct BoundedFace {
  explicit BoundedFace(const FaceMotion& motion);

  const FaceMotion* motion;
  bool rests;              ///< whether the face is at the same place at the start and at the end
  Eigen::Vector3d normal;  ///< unit normal at the start; zero if the face is degenerate
  Eigen::Vector3d center;  ///< of a ball that holds the face during the whole leg
  double radius;           ///< of that ball
};

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
  Eigen::Vector3d low() const { return low_.array() - reach_; }
  Eigen::Vector3d high() const { return high_.array() + reach_; }

  /// A time of the leg before which the face surely stays farther from the box than the radius less
  /// `closer` [m]; above 1 if it does so during the whole leg. Tests fixed planes: those at right
  /// angles to axes(), and the face's own plane at the start.
  double clear_until(const BoundedFace& face, double closer = 0.0) const;
  /// [m] A lower bound of the distance between the covered space and the face during the leg.
  double distance_bound(const FaceMotion& face) const;
  /// A box around the covered space.
  OrientedBox bounds() const;

 private:
  /// The box at one end of the leg.
  struct Place {
    Eigen::Vector3d center;
    Eigen::Matrix3d half_edges;  ///< columns
    Eigen::Vector3d low, high;   ///< projections onto `axes_`
  };
  Place place(const OrientedBox& box, const Eigen::Isometry3d& pose) const;

  Eigen::Matrix3d axes_;
  bool rests_;
  Place start_, end_;
  Eigen::Vector3d low_, high_;  ///< of both places together
  double reach_;                ///< [m] radius plus chord deviation
};

/// A box around all positions of an axis during a leg. Its first edge is along the axis, the second
/// one along the motion of the tip. An axis at rest has a box without width.
OrientedBox box_around(const ShaftMotion& motion);

}  // namespace organ_collision
