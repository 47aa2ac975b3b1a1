#pragma once

#include <Eigen/Core>

#include "geometry/organ/face_motion.hpp"

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

}  // namespace organ_collision
