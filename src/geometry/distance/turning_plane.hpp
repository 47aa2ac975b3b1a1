#pragma once

#include <Eigen/Core>
#include <limits>

#include "closest_points.hpp"
#include "geometry/organ/face_motion.hpp"
#include "geometry/tool/core_motion.hpp"

namespace organ_collision {

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
