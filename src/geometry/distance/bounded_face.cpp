#include "bounded_face.hpp"

#include <algorithm>
#include <cmath>

#include "separating_plane.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d center_of(const FaceMotion& motion) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) sum += motion.start[i] + motion.end[i];
  return sum / 6.0;
}

/// [m] The ball around `center` with this radius holds all corners at both ends, and with them all
/// points of the face in between.
double radius_around(const Vector3d& center, const FaceMotion& motion) {
  double squared = 0.0;
  for (const Triangle* place : {&motion.start, &motion.end}) {
    for (const Vector3d& corner : *place) {
      squared = std::max(squared, (corner - center).squaredNorm());
    }
  }
  return std::sqrt(squared);
}

}  // namespace

BoundedFace::BoundedFace(const FaceMotion& motion)
    : motion(&motion),
      rests(motion.start == motion.end),
      normal(plane_normal(motion.start)),
      center(center_of(motion)),
      radius(radius_around(center, motion)) {}

}  // namespace organ_collision
