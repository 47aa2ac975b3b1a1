#include "first_touch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "organ_collision/geometry/tolerances.hpp"
#include "separating_plane.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// Core and face at one time, and the unit direction between their nearest points.
struct Instant {
  double time;
  ConvexCore core;
  Triangle face;
  ClosestPoints closest;
  Vector3d normal;  ///< from the core to the face; zero where they meet

  Instant(double at, const CoreMotion& motion, const FaceMotion& face_motion,
          double enough = std::numeric_limits<double>::infinity())
      : time(at),
        core(motion.at(at)),
        face(face_motion.at(at)),
        closest(closest_points(core, face, enough)),
        normal(closest.apart.normalized()) {}
};

/// First root in (0, 1] of the quadratic with Bernstein coefficients a > 0, b, c; 2 if there is
/// none.
double first_root(double a, double b, double c) {
  if (b >= 0.0 && c > 0.0) return 2.0;  // the control polygon does not reach zero
  const double linear = b - a;          // half of it
  const double square = a - 2.0 * b + c;
  const double discriminant = linear * linear - square * a;
  if (discriminant < 0.0) return 2.0;
  const double root = std::sqrt(discriminant);
  const double place = linear < 0.0 ? a / (root - linear) : -(root + linear) / square;
  return place >= 0.0 && place <= 1.0 ? place : 2.0;
}

/// The share of the time from `from` to `to` for which a plane that turns linearly from the one
/// normal to the other surely keeps the face farther than `radius` from the core; above 1 if it is
/// all of it. The distance is at least a corner's height over the plane divided by the length of
/// the turning normal n, and that length is at most (1 + n²) / 2: a quadratic in time, as the
/// heights of corners over points of the core that move linearly are. A point that moves along a
/// curve is off its chord by at most 4 s (1 - s) bends; a rim reaches out by the length of
/// such a quadratic, which is at most the one of its coefficients' lengths.
double clear_share(const Instant& from, const Instant& to, const CoreMotion& core, double radius) {
  const bool turns = from.normal.dot(to.normal) > 0.0;
  const Vector3d& turned = turns ? to.normal : from.normal;
  const auto &rim = from.core.rim, &rim_after = to.core.rim;
  const double duration = to.time - from.time;
  const double bend = std::max(core.bend(duration, from.normal), core.bend(duration, turned));
  const double radius_amid = 0.5 * (1.0 + from.normal.dot(turned)) * radius;
  const double before = radius + (rim.transpose() * from.normal).norm();
  const double amid = radius_amid + 2.0 * bend +
                      0.5 * (rim_after.transpose() * from.normal + rim.transpose() * turned).norm();
  const double after = radius + (rim_after.transpose() * turned).norm();
  double share = 2.0;
  for (int corner = 0; corner < 3; ++corner) {
    for (std::size_t point = 0; point < from.core.count; ++point) {
      const Vector3d height = from.face[corner] - from.core.points[point];
      const Vector3d height_after = to.face[corner] - to.core.points[point];
      // No corner is nearer than the nearest points; only rounding can say so.
      const double a = std::max(from.normal.dot(height) - before, from.closest.distance - radius);
      const double b = 0.5 * (from.normal.dot(height_after) + turned.dot(height)) - amid;
      const double c = turned.dot(height_after) - after;
      share = std::min(share, first_root(a, b, c));
    }
  }
  return share;
}

/// [m] No point of the core comes nearer to a point of the face by more than this.
double farthest_move(const CoreMotion& core, const FaceMotion& face) {
  double corner = 0.0;
  for (int i = 0; i < 3; ++i) corner = std::max(corner, (face.end[i] - face.start[i]).norm());
  return corner + core.farthest_move();
}

/// [m] The largest coordinate of the core and the face at both ends of the leg.
double extent(const CoreMotion& core, const FaceMotion& face) {
  double largest = 0.0;
  const auto consider = [&](const Vector3d& point) {
    largest = std::max(largest, point.cwiseAbs().maxCoeff());
  };
  for (const ConvexCore* end : {&core.start(), &core.end()}) {
    for (std::size_t i = 0; i < end->count; ++i) consider(end->points[i]);
  }
  for (const Triangle* end : {&face.start, &face.end}) {
    for (const Vector3d& corner : *end) consider(corner);
  }
  return largest;
}

}  // namespace

bool stays_beyond(const Vector3d& normal, const CoreMotion& core, const FaceMotion& face,
                  double distance) {
  const double reach = distance + core.bend(1.0, normal);
  return heights(normal, face.start).low - core.start().height(normal) > reach &&
         heights(normal, face.end).low - core.end().height(normal) > reach;
}

std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      WorkBudget& budget, double until) {
  constexpr int kMaxSteps = 1000;  // Some ten suffice.
  if (budget.is_used_up() && !core.start().is_axis()) {
    // A pair of points on core and face that costs no search.
    return FirstTouch{0.0, closest_points(core.start().axis(), face.start), false};
  }
  const double move = farthest_move(core, face);
  const double near = radius + move;
  Instant now(0.0, core, face, near);
  budget.spend(now.closest.steps);
  if (now.closest.distance <= radius) return FirstTouch{0.0, now.closest};
  if (now.closest.distance > near || until == 0.0) return std::nullopt;
  const double touching = radius + tolerance::kTouch + tolerance::kRounding * extent(core, face);
  if (stays_beyond(now.normal, core, face, touching)) return std::nullopt;
  // Nothing touches for this share of the leg, however little the direction of near points tells.
  const auto sure = [&] { return (now.closest.distance - radius) / move; };
  Instant ahead(until, core, face);
  for (int step = 0; step < kMaxSteps && !budget.is_used_up(); ++step) {
    budget.spend(ahead.closest.steps);
    const double length = ahead.time - now.time;
    const double share = std::max(clear_share(now, ahead, core, radius), sure() / length);
    const double before = now.closest.distance;
    now = share > 1.0 ? ahead : Instant(now.time + share * length, core, face);
    budget.spend(now.closest.steps);
    if (now.closest.distance <= touching) return FirstTouch{now.time, now.closest};
    if (now.time >= until) return std::nullopt;
    double next = 2.0;
    if (share <= 1.0) {
      // Twice the time until they touch, if they come nearer as fast as they did.
      const double approach = (before - now.closest.distance) / share;
      next = 2.0 * (now.closest.distance - radius) / approach;
      if (!(next > 0.0 && next < 0.25)) next = 0.25;
    }
    ahead = Instant(std::min(now.time + std::max(next * length, sure()), until), core, face);
  }
  return FirstTouch{now.time, now.closest, false};  // rather one contact too many
}

std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      double until) {
  WorkBudget unlimited = WorkBudget::unlimited();
  return first_touch(core, face, radius, unlimited, until);
}

}  // namespace organ_collision
