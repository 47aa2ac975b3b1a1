#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "closest_points.hpp"
#include "geometry/organ/organ_motion.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tool/tool_surface.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// The unit normal of a triangle's plane; zero if the triangle is degenerate. Faster than Eigen's
/// stableNormalized(), and as exact.
inline Eigen::Vector3d plane_normal(const Triangle& corners) {
  const Eigen::Vector3d area = twice_area(corners);
  const double squared = area.squaredNorm();
  const bool is_exact = squared > 1e-200 && squared < 1e200;  // Neither underflow nor overflow.
  return is_exact ? Eigen::Vector3d(area / std::sqrt(squared)) : area.stableNormalized();
}

inline ProjectionInterval project_onto(const Eigen::Vector3d& direction, const Triangle& corners) {
  const double a = direction.dot(corners[0]), b = direction.dot(corners[1]);
  const double c = direction.dot(corners[2]);
  return {std::min({a, b, c}), std::max({a, b, c})};
}

/// The first zero, in [0, 1], of the linear function from `start` to `end`: 0 if `start` is not
/// positive, 2 if the function stays positive. If a gap is never smaller than the function, it is
/// positive before that zero.
inline double first_zero(double start, double end) {
  if (start <= 0.0) return 0.0;
  return end > 0.0 ? 2.0 : start / (start - end);
}

/// A face during one leg [m], with values that many tests of this face need. Refers to the face's
/// motion, which must outlive this object.
struct LegFace {
  explicit LegFace(const FaceMotion& motion)
      : motion(&motion), rests(motion.start == motion.end), normal(plane_normal(motion.start)) {}

  /// A time of the leg, in [0, 1], before which a plane with the fixed normal `plane` proves that
  /// the face and a part of a tool are farther apart than some distance; 2 if it proves this for
  /// the whole leg. `part` and `part_at_end` are the projections of the part onto the normal.
  /// `reach` [m] is the distance plus the chord deviation.
  double clear_until(const Eigen::Vector3d& plane, const ProjectionInterval& part,
                     const ProjectionInterval& part_at_end, double reach) const {
    const ProjectionInterval face = project_onto(plane, motion->start);
    const ProjectionInterval at_end = rests ? face : project_onto(plane, motion->end);
    return std::max(
        first_zero(face.low - part.high - reach, at_end.low - part_at_end.high - reach),
        first_zero(part.low - face.high - reach, part_at_end.low - at_end.high - reach));
  }

  const FaceMotion* motion;
  bool rests;              ///< whether the face is at the same place at the start and at the end
  Eigen::Vector3d normal;  ///< unit normal at the start; zero if the face is degenerate
};

/// Planes with a fixed normal that touch a part of a tool at the start and at the end of a leg.
class FixedPlane {
 public:
  /// `normal` is unit and points away from the part.
  FixedPlane(const Eigen::Vector3d& normal, const CoreMotion& core);
  FixedPlane(const Eigen::Vector3d& normal, const ToolSurface& surface, const RigidMotion& motion);

  /// Whether the planes prove that the part stays farther than `distance` [m] from the face during
  /// the whole leg. If the result is false, the part may stay farther away all the same.
  bool keeps_beyond(const FaceMotion& face, double distance) const {
    return project_onto(normal_, face.start).low > distance + start_ &&
           project_onto(normal_, face.end).low > distance + end_;
  }
  /// [m] The greatest support value of the part along the normal during the leg.
  double support() const { return std::max(start_, end_); }

 private:
  Eigen::Vector3d normal_;
  /// [m] The part's support values along the normal, grown by the chord deviation.
  double start_, end_;
};

/// A core and a face at one time of the leg, with their nearest points and the direction of the
/// plane that separates them.
struct Instant {
  double time;  ///< the time, in [0, 1] of the leg
  ConvexCore core;
  Triangle face;
  ClosestPoints closest;
  Eigen::Vector3d normal;  ///< unit, from the core to the face; zero if they meet

  /// `distance_bound` [m] is as for closest_points().
  Instant(double time, const CoreMotion& core_motion, const FaceMotion& face_motion,
          double distance_bound = std::numeric_limits<double>::infinity());
  /// For a time at which the nearest points are known already.
  Instant(double time, const CoreMotion& core_motion, const FaceMotion& face_motion,
          const ClosestPoints& closest);
};

/// The share of the interval between two instants for which a turning plane proves that the
/// distance of core and face stays above `radius` [m]; above 1 if it proves this for the whole
/// interval. In truth the distance may stay above `radius` for longer.
///
/// The normal of the plane turns linearly from `from.normal` to `to.normal`. The distance along
/// this normal from a point of the core to a corner of the face is a quadratic function of time.
/// See doc/theory/geometry.md, First touch, and Rims and chord deviation.
double clear_share(const Instant& from, const Instant& to, const CoreMotion& core, double radius);

}  // namespace organ_collision
