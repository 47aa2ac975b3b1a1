#include "separating_plane.hpp"

#include <cstddef>

namespace organ_collision {

bool stays_beyond(const Eigen::Vector3d& normal, const CoreMotion& core, const FaceMotion& face,
                  double distance) {
  const double reach = distance + core.chord_deviation(1.0, normal);
  return project_onto(normal, face.start).low - core.start().support_value(normal) > reach &&
         project_onto(normal, face.end).low - core.end().support_value(normal) > reach;
}

namespace {

using Eigen::Vector3d;

/// [m] How far a corner must be from a point of the core, along the turning normal, to be certainly
/// farther than `radius` from the core: the radius, the support value of the core's rim, and the
/// chord deviation. `normal_from` and `normal_to` are the normals at both ends.
BernsteinQuadratic required_gap(const Instant& from, const Instant& to, const CoreMotion& core,
                                double radius, const Vector3d& normal_from,
                                const Vector3d& normal_to) {
  const auto &rim_from = from.core.rim, &rim_to = to.core.rim;
  const double duration = to.time - from.time;
  const double deviation = std::max(core.chord_deviation(duration, normal_from),
                                    core.chord_deviation(duration, normal_to));
  // The length of the turning normal is at most the quadratic with the coefficients 1,
  // normal_length, 1. The deviation at time t is at most 4 t (1 - t) times the largest deviation, a
  // quadratic with the coefficients 0, 2, 0 times that deviation.
  const double normal_length = 0.5 * (1.0 + normal_from.dot(normal_to));
  return {radius + (rim_from.transpose() * normal_from).norm(),
          normal_length * radius + 2.0 * deviation +
              0.5 * (rim_to.transpose() * normal_from + rim_from.transpose() * normal_to).norm(),
          radius + (rim_to.transpose() * normal_to).norm()};
}

}  // namespace

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
  // A plane that would turn by a right angle or more keeps its direction.
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
      // No corner is nearer than the nearest points, except by rounding.
      gap.start = std::max(gap.start, from.closest.distance - radius);
      share = std::min(share, first_root(gap));
    }
  }
  return share;
}

}  // namespace organ_collision
