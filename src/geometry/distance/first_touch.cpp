#include "first_touch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "closest_points.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "separating_plane.hpp"
#include "triangle_crossing.hpp"

namespace organ_collision {
namespace {

/// An unresolved touch at the start. Its pair of points belongs to core and face but need not be
/// the nearest one, so that it needs no iteration.
FirstTouch unresolved_at_start(const CoreMotion& core, const FaceMotion& face) {
  return {0.0, axis_closest_points(core.start().axis(), face.start), false};
}

/// As closest_points(). Of triangles that touch when a leg begins, most cross each other.
ClosestPoints closest_at_start(const ConvexCore& core, const Triangle& face,
                               double distance_bound) {
  if (core.is_triangle()) {
    const auto decided = triangle_crossing(core.triangle(), face, distance_bound);
    if (decided) return *decided;
  }
  return closest_points(core, face, distance_bound);
}

/// [m] Distances up to this count as a touch.
double touching_distance(const CoreMotion& core, const FaceMotion& face, double radius) {
  const double extent = std::max(core.largest_coordinate(), face.largest_coordinate());
  return radius + tolerance::kTouch + tolerance::kRounding * extent;
}

/// How long the next interval should be, as a multiple of the last one. Nothing touched during the
/// first `share` of the last interval. The distances [m] are those at the start and at the end of
/// that share.
double next_length(double share, double distance_before, double distance, double radius) {
  if (share > 1.0) return 2.0;
  // Twice the time until core and face touch, if they go on approaching as fast as before.
  const double approach = (distance_before - distance) / share;
  const double length = 2.0 * (distance - radius) / approach;
  return length > 0.0 && length < 0.25 ? length : 0.25;
}

/// [m per leg] How fast the distance of a link's core and a face falls. The closest points follow
/// from each other at first order, so this is the velocity of these points along the normal.
double closing_speed(const Instant& now, const RigidMotion& link, const FaceMotion& face) {
  const Eigen::Vector3d displacement = link.end().translation() - link.start().translation();
  const Eigen::Vector3d origin = link.start().translation() + now.time * displacement;
  const Eigen::Vector3d arm = now.closest.on_core - origin;
  const Eigen::Vector3d of_core = displacement + link.angle() * link.axis().cross(arm);
  const Triangle velocities = {face.end[0] - face.start[0], face.end[1] - face.start[1],
                               face.end[2] - face.start[2]};
  return now.normal.dot(of_core - point_at(velocities, now.closest.barycentric));
}

/// Aims at the time at which a link touches, by Newton's method. An interval that ends just before
/// the touch is clear as a whole. One that ends behind it gives no plane that turns, because no
/// direction is defined where core and face meet. The aim therefore falls short of the touch by as
/// much as the last one was wrong.
class TouchAim {
 public:
  /// `touching` [m] is the distance that counts as a touch.
  TouchAim(const RigidMotion& link, const FaceMotion& face, double radius, double touching)
      : link_(link), face_(face), radius_(radius), least_target_(0.5 * (touching - radius)) {}

  /// How far to look ahead of an instant; infinite if core and face do not approach.
  double ahead_of(const Instant& now) {
    gap_ = now.closest.distance - radius_;
    speed_ = closing_speed(now, link_, face_);
    if (!(speed_ > 0.0)) return std::numeric_limits<double>::infinity();
    return (gap_ - std::max(shortfall_ * gap_, least_target_)) / speed_;
  }

  /// Learns from the distance found at this time after the last instant.
  void learn(double after, double distance) {
    const double expected = std::max(gap_ - speed_ * after, 0.0);
    const double found = std::max(distance - radius_, 0.0);
    shortfall_ = std::min(std::abs(found - expected) / gap_, kMostShortfall);
  }

 private:
  static constexpr double kMostShortfall = 0.5;

  const RigidMotion& link_;
  const FaceMotion& face_;
  const double radius_, least_target_;  ///< [m]
  double gap_ = 0.0;                    ///< [m] distance without the radius, at the last instant
  double speed_ = 0.0;                  ///< [m per leg]
  double shortfall_ = 0.1;              ///< [1] of the gap
};

}  // namespace

std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      WorkBudget& budget, double until) {
  constexpr int kMaxAdvances = 1000;  // About ten are needed.
  if (budget.is_used_up() && !core.start().is_axis()) return unresolved_at_start(core, face);

  const double farthest_move = core.farthest_move() + face.farthest_move();
  const double out_of_reach = radius + farthest_move;
  const ClosestPoints at_start = closest_at_start(core.start(), face.start, out_of_reach);
  budget.spend(at_start.steps);
  if (at_start.distance <= radius) return FirstTouch{0.0, at_start};
  if (at_start.distance > out_of_reach || until == 0.0) return std::nullopt;
  Instant now(0.0, core, face, at_start);
  const double touching = touching_distance(core, face, radius);
  if (stays_beyond(now.normal, core, face, touching)) return std::nullopt;

  // Nothing moves fast enough to touch earlier than after this time. This advances the search even
  // where the nearest points are too close to each other to give a reliable normal.
  const auto clear_time = [&] { return (now.closest.distance - radius) / farthest_move; };
  std::optional<TouchAim> aim;
  if (core.link()) aim.emplace(*core.link(), face, radius, touching);
  Instant ahead(aim ? std::min(aim->ahead_of(now), until) : until, core, face);
  for (int advance = 0; advance < kMaxAdvances && !budget.is_used_up(); ++advance) {
    budget.spend(ahead.closest.steps);
    const double length = ahead.time - now.time;
    const double share = std::max(clear_share(now, ahead, core, radius), clear_time() / length);
    const double distance_before = now.closest.distance;
    if (aim) aim->learn(length, ahead.closest.distance);
    if (share > 1.0) {
      now = ahead;
    } else {
      now = Instant(now.time + share * length, core, face);
      budget.spend(now.closest.steps);
    }
    if (now.closest.distance <= touching) return FirstTouch{now.time, now.closest};
    if (now.time >= until) return std::nullopt;
    const double next =
        aim ? std::min(aim->ahead_of(now), length * (share > 1.0 ? 4.0 : 0.5))
            : length * next_length(share, distance_before, now.closest.distance, radius);
    ahead = Instant(std::min(now.time + std::max(next, clear_time()), until), core, face);
  }
  return FirstTouch{now.time, now.closest, false};
}

std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      double until) {
  WorkBudget unlimited = WorkBudget::unlimited();
  return first_touch(core, face, radius, unlimited, until);
}

}  // namespace organ_collision
