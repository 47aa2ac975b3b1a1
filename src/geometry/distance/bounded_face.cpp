#include "bounded_face.hpp"

#include <algorithm>
#include <cmath>

#include "separating_plane.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d sum_of(const Triangle& corners) { return corners[0] + corners[1] + corners[2]; }

/// [m^2] The square of the distance to the farthest corner.
double squared_reach(const Vector3d& center, const Triangle& corners) {
  return std::max({(corners[0] - center).squaredNorm(), (corners[1] - center).squaredNorm(),
                   (corners[2] - center).squaredNorm()});
}

Vector3d center_of(const FaceMotion& motion, bool rests) {
  if (rests) return sum_of(motion.start) / 3.0;
  return (sum_of(motion.start) + sum_of(motion.end)) / 6.0;
}

/// [m] The ball around `center` with this radius holds all corners at both ends, and with them all
/// points of the face in between.
double radius_around(const Vector3d& center, const FaceMotion& motion, bool rests) {
  const double at_start = squared_reach(center, motion.start);
  return std::sqrt(rests ? at_start : std::max(at_start, squared_reach(center, motion.end)));
}

}  // namespace

BoundedFace::BoundedFace(const FaceMotion& motion)
    : motion(&motion),
      rests(motion.start == motion.end),
      normal(plane_normal(motion.start)),
      center(center_of(motion, rests)),
      radius(radius_around(center, motion, rests)) {}

}  // namespace organ_collision
