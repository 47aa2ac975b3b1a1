#include "separating_plane.hpp"

#include <cstddef>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// A quadratic polynomial over [0, 1], given by its Bernstein coefficients: the values at both ends
/// and the control value between them.
struct BernsteinQuadratic {
  double start, middle, end;
};

/// The first root in (0, 1] of a quadratic whose value at the start is positive; 2 if there is no
/// root.
double first_root(const BernsteinQuadratic& quadratic) {
  const auto& [start, middle, end] = quadratic;
  if (middle >= 0.0 && end > 0.0) return 2.0;  // No coefficient is negative.
  const double half_linear = middle - start;
  const double square = start - 2.0 * middle + end;
  const double discriminant = half_linear * half_linear - square * start;
  if (discriminant < 0.0) return 2.0;
  const double root = std::sqrt(discriminant);
  // The quadratic formula has two equivalent forms. The sign of half_linear decides which of them
  // does not subtract numbers of similar size.
  const double place =
      half_linear < 0.0 ? start / (root - half_linear) : -(root + half_linear) / square;
  return place >= 0.0 && place <= 1.0 ? place : 2.0;
}

/// [m] How far a corner must be from a point of the core, along the turning normal, to be certainly
/// farther than `radius` from the core: the radius, the support value of the core's rim, and the
/// chord deviation. `normal_from` and `normal_to` are the unit normals at both ends of the
/// interval.
BernsteinQuadratic required_gap(const Instant& from, const Instant& to, const CoreMotion& core,
                                double radius, const Vector3d& normal_from,
                                const Vector3d& normal_to) {
  const auto &rim_from = from.core.rim, &rim_to = to.core.rim;
  const double duration = to.time - from.time;
  const double deviation = std::max(core.chord_deviation(duration, normal_from),
                                    core.chord_deviation(duration, normal_to));
  // The length of the turning normal is at most the quadratic with the coefficients 1,
  // normal_length, 1. The chord deviation at time t is at most 4 t (1 - t) * deviation. This
  // quadratic has the coefficients 0, 2 * deviation, 0.
  const double normal_length = 0.5 * (1.0 + normal_from.dot(normal_to));
  return {radius + (rim_from.transpose() * normal_from).norm(),
          normal_length * radius + 2.0 * deviation +
              0.5 * (rim_to.transpose() * normal_from + rim_from.transpose() * normal_to).norm(),
          radius + (rim_to.transpose() * normal_to).norm()};
}

}  // namespace

FixedPlane::FixedPlane(const Vector3d& normal, const CoreMotion& core) : normal_(normal) {
  const double deviation = core.chord_deviation(1.0, normal);
  start_ = core.start().support_value(normal) + deviation;
  end_ = core.end().support_value(normal) + deviation;
}

FixedPlane::FixedPlane(const Vector3d& normal, const ToolSurface& surface,
                       const RigidMotion& motion)
    : normal_(normal) {
  const double deviation = motion.chord_deviation(surface.nodes().front().box);
  const auto support_value = [&](const Eigen::Isometry3d& pose) {
    return surface.project_onto(pose.linear().transpose() * normal).high +
           normal.dot(pose.translation());
  };
  start_ = support_value(motion.start()) + deviation;
  end_ = motion.rests() ? start_ : support_value(motion.end()) + deviation;
}

Instant::Instant(double time, const CoreMotion& core_motion, const FaceMotion& face_motion,
                 double distance_bound)
    : time(time),
      core(core_motion.at(time)),
      face(face_motion.at(time)),
      closest(closest_points(core, face, distance_bound)),
      normal(closest.separation.normalized()) {}

Instant::Instant(double time, const CoreMotion& core_motion, const FaceMotion& face_motion,
                 const ClosestPoints& closest)
    : time(time),
      core(core_motion.at(time)),
      face(face_motion.at(time)),
      closest(closest),
      normal(closest.separation.normalized()) {}

double clear_share(const Instant& from, const Instant& to, const CoreMotion& core, double radius) {
  // If the plane would turn by a right angle or more, its normal stays `from.normal`.
  const bool turns = from.normal.dot(to.normal) > 0.0;
  const Vector3d& normal_from = from.normal;
  const Vector3d& normal_to = turns ? to.normal : from.normal;
  const BernsteinQuadratic required = required_gap(from, to, core, radius, normal_from, normal_to);
  double share = 2.0;
  for (int corner = 0; corner < 3; ++corner) {
    for (std::size_t point = 0; point < from.core.count; ++point) {
      const Vector3d separation_from = from.face[corner] - from.core.points[point];
      const Vector3d separation_to = to.face[corner] - to.core.points[point];
      BernsteinQuadratic gap{
          normal_from.dot(separation_from) - required.start,
          0.5 * (normal_from.dot(separation_to) + normal_to.dot(separation_from)) - required.middle,
          normal_to.dot(separation_to) - required.end};
      // Except for rounding, no corner is nearer along the normal than the nearest points are.
      gap.start = std::max(gap.start, from.closest.distance - radius);
      share = std::min(share, first_root(gap));
    }
  }
  return share;
}

}  // namespace organ_collision
