#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "closest_points.hpp"
#include "geometry/organ/organ_motion.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/projection_interval.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// A quadratic polynomial over [0, 1] by its Bernstein coefficients: the values at both ends, and
/// the control value between them.
struct BernsteinQuadratic {
  double start, middle, end;
};

/// The first root in (0, 1] of a quadratic whose value at the start is positive; 2 if it has no
/// such root.
inline double first_root(const BernsteinQuadratic& quadratic) {
  const auto& [start, middle, end] = quadratic;
  if (middle >= 0.0 && end > 0.0) return 2.0;  // The control polygon stays positive.
  const double half_linear = middle - start;
  const double square = start - 2.0 * middle + end;
  const double discriminant = half_linear * half_linear - square * start;
  if (discriminant < 0.0) return 2.0;
  const double root = std::sqrt(discriminant);
  // The solution has two equivalent forms. The sign of half_linear decides which one does not
  // cancel digits.
  const double place =
      half_linear < 0.0 ? start / (root - half_linear) : -(root + half_linear) / square;
  return place >= 0.0 && place <= 1.0 ? place : 2.0;
}

/// The direction of a vector, of length 1; zero if the vector is zero. Faster than Eigen's
/// stableNormalized(), and as exact.
inline Eigen::Vector3d unit_vector(const Eigen::Vector3d& vector) {
  const double squared = vector.squaredNorm();
  const bool is_exact = squared > 1e-200 && squared < 1e200;  // The square has all its digits.
  return is_exact ? Eigen::Vector3d(vector / std::sqrt(squared)) : vector.stableNormalized();
}

/// Unit normal of a triangle's plane; zero if the triangle is degenerate.
inline Eigen::Vector3d plane_normal(const Triangle& corners) {
  return unit_vector(twice_area(corners));
}

inline ProjectionInterval project_onto(const Eigen::Vector3d& direction, const Triangle& corners) {
  const double a = direction.dot(corners[0]), b = direction.dot(corners[1]);
  const double c = direction.dot(corners[2]);
  return {std::min({a, b, c}), std::max({a, b, c})};
}

/// The first zero, in [0, 1], of the linear function from `start` to `end`: 0 if `start` is not
/// positive, 2 if the function stays positive. A gap that is never smaller than this function is
/// positive before that time.
inline double first_zero(double start, double end) {
  if (start <= 0.0) return 0.0;
  return end > 0.0 ? 2.0 : start / (start - end);
}

/// A time of the leg, in [0, 1], before which a plane with a fixed normal certainly keeps a face
/// and a part of a tool farther than some distance from each other; 2 if it does so during the
/// whole leg. The intervals are the projections onto the normal at the start and at the end of the
/// leg. `reach` [m] is that distance plus the chord deviation.
inline double clear_until(const ProjectionInterval& face, const ProjectionInterval& face_at_end,
                          const ProjectionInterval& part, const ProjectionInterval& part_at_end,
                          double reach) {
  return std::max(
      first_zero(face.low - part.high - reach, face_at_end.low - part_at_end.high - reach),
      first_zero(part.low - face.high - reach, part_at_end.low - face_at_end.high - reach));
}

/// Whether the plane with this fixed normal keeps the core farther than `distance` [m] from the
/// face during the whole leg. `normal` is unit and points from the core to the face. False decides
/// nothing.
bool stays_beyond(const Eigen::Vector3d& normal, const CoreMotion& core, const FaceMotion& face,
                  double distance);

/// A core and a face at one time of the leg, with their nearest points and the direction of the
/// plane that separates them.
struct Instant {
  double time;  ///< in [0, 1] of the leg
  ConvexCore core;
  Triangle face;
  ClosestPoints closest;
  Eigen::Vector3d normal;  ///< unit, from the core to the face; zero where they meet

  /// `distance_bound` [m] is as for closest_points().
  Instant(double time, const CoreMotion& core_motion, const FaceMotion& face_motion,
          double distance_bound = std::numeric_limits<double>::infinity());
  /// With known nearest points.
  Instant(double time, const CoreMotion& core_motion, const FaceMotion& face_motion,
          const ClosestPoints& closest);
};

/// The share of the interval between two instants during which the distance of core and face
/// certainly stays above `radius` [m]; above 1 if it does so during the whole interval. This is a
/// lower bound: the true share may be larger.
///
/// The bound comes from a plane whose normal turns linearly from `from.normal` to `to.normal`.
/// Along this normal, the separation of each pair of corner and core point is a quadratic in time.
/// See doc/geometry.md, First touch, and Rims and chord deviation.
double clear_share(const Instant& from, const Instant& to, const CoreMotion& core, double radius);

}  // namespace organ_collision
