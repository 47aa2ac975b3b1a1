#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// Unit, at right angles to a triangle's plane; zero if it has none.
inline Eigen::Vector3d plane_normal(const Triangle& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
}

/// An interval of heights along a direction.
struct Heights {
  double low, high;
};

inline Heights heights(const Eigen::Vector3d& direction, const Triangle& corners) {
  const double a = direction.dot(corners[0]), b = direction.dot(corners[1]);
  const double c = direction.dot(corners[2]);
  return {std::min({a, b, c}), std::max({a, b, c})};
}

/// When a gap that changes linearly from one value to the other, or is larger, may first be zero or
/// less: in [0, 1]; 2: never.
inline double first_zero(double from, double to) {
  if (from <= 0.0) return 0.0;
  return to > 0.0 ? 2.0 : from / (from - to);
}

/// A time of the leg before which a plane at right angles to a direction surely keeps a face and a
/// part of a tool farther apart than `reach`, whose points move linearly but for what `reach` makes
/// up for. Heights of both at both ends of the leg; 2: all the time.
inline double clear_until(const Heights& face, const Heights& face_at_end, const Heights& part,
                          const Heights& part_at_end, double reach) {
  return std::max(
      first_zero(face.low - part.high - reach, face_at_end.low - part_at_end.high - reach),
      first_zero(part.low - face.high - reach, part_at_end.low - face_at_end.high - reach));
}

}  // namespace organ_collision
