#pragma once

#include "geometry/organ/face_motion.hpp"
#include "geometry/tool/rigid_motion.hpp"
#include "organ_collision/geometry/tool/oriented_box.hpp"

namespace organ_collision {

/// A face during one leg, as seen from a moving link: in the link's frame [m]. What belongs to the
/// link rests in this frame, so that one RelativeFace is tested against many boxes and triangles of
/// the link. See doc/geometry.md, Swept boxes.
class RelativeFace {
 public:
  /// `face` is in the organ's frame.
  RelativeFace(const FaceMotion& face, const RigidMotion& link);

  /// A time of the leg before which the face surely stays farther than `reach` [m] from a box in
  /// the link's frame; above 1 if it does so during the whole leg. Tests fixed planes: those at
  /// right angles to the box's axes, and the face's own plane at the start. If the face's ball is
  /// small beside the box, it stands for the face.
  double clear_until(const OrientedBox& box, double reach) const;
  /// The same for a triangle in the link's frame with its unit normal. Tests the planes of face and
  /// triangle.
  double clear_until(const Triangle& triangle, const Eigen::Vector3d& normal, double reach) const;

 private:
  FaceMotion chord_;        ///< linear, between the places at the start and at the end of the leg
  Eigen::Vector3d normal_;  ///< unit normal at the start; zero if the face is degenerate
  double deviation_;        ///< [m] how far its points may be from their places on the chord
  Eigen::Vector3d center_;  ///< of a ball that holds the face during the whole leg
  double radius_;           ///< [m] of that ball
  bool rests_;              ///< whether the chord's start and end are the same
};

}  // namespace organ_collision
