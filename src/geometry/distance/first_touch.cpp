#include "first_touch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "organ_collision/geometry/tolerances.hpp"
#include "separating_plane.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// A point at which the border of a triangle passes through the plane of another triangle.
struct BorderPoint {
  Vector3d point;   ///< [m] the place of this point
  int from, to;     ///< the corners of the edge that passes through the plane
  double fraction;  ///< the place on the edge, in [0, 1] from corner `from` to corner `to`
  double along;     ///< place on the line in which both planes meet
};

/// The segment in which a triangle cuts a plane, by its two ends. The end with the smaller `along`
/// is first.
using Section = std::array<BorderPoint, 2>;

/// For each corner, its distance in front of the plane through `point` with the normal `normal`,
/// times the length of `normal`.
Vector3d heights(const Triangle& corners, const Vector3d& normal, const Vector3d& point) {
  return {normal.dot(corners[0] - point), normal.dot(corners[1] - point),
          normal.dot(corners[2] - point)};
}

/// Whether all three corners are on one side of the plane from which their heights are measured.
bool is_on_one_side(const Vector3d& heights) {
  return (heights.array() > 0.0).all() || (heights.array() <= 0.0).all();
}

/// Cuts a triangle by a plane. The triangle must have corners on both sides of the plane.
/// `direction` is the direction of the line in which the triangle's plane meets that plane.
Section cut(const Triangle& corners, const Vector3d& heights, const Vector3d& direction,
            const Vector3d& origin) {
  // The lone corner is the only one on its side of the plane.
  const bool side[] = {heights[0] > 0.0, heights[1] > 0.0, heights[2] > 0.0};
  const int lone = side[1] == side[2] ? 0 : side[0] == side[2] ? 1 : 2;
  Section section;
  for (int end = 0; end < 2; ++end) {
    const int to = (lone + 1 + end) % 3;
    const double fraction = heights[lone] / (heights[lone] - heights[to]);
    const Vector3d point = corners[lone] + fraction * (corners[to] - corners[lone]);
    section[end] = {point, lone, to, fraction, direction.dot(point - origin)};
  }
  if (section[1].along < section[0].along) std::swap(section[0], section[1]);
  return section;
}

/// The place on a section at `along`, in [0, 1] from its first end to its second one.
double place_at(const Section& section, double along) {
  const double length = section[1].along - section[0].along;
  if (!(length > 0.0)) return 0.0;
  return std::clamp((along - section[0].along) / length, 0.0, 1.0);
}

Vector3d point_on(const Section& section, double place) {
  return section[0].point + place * (section[1].point - section[0].point);
}

/// The barycentric coordinates, in the triangle, of a place on its section.
Vector3d barycentric_at(const Section& section, double place) {
  Vector3d weights = Vector3d::Zero();
  for (int end = 0; end < 2; ++end) {
    const BorderPoint& border = section[end];
    const double share = end == 0 ? 1.0 - place : place;
    weights[border.from] += share * (1.0 - border.fraction);
    weights[border.to] += share * border.fraction;
  }
  return weights;
}

/// How long the next interval should be, as a multiple of the last one. Nothing touches during the
/// share `share` of the last interval. `distance_before` and `distance` [m] are the distances at
/// the start and at the end of that share.
double next_length(double share, double distance_before, double distance, double radius) {
  if (share > 1.0) return 2.0;
  // Twice the time until core and face touch, if they go on approaching as fast as before.
  const double approach = (distance_before - distance) / share;
  const double length = 2.0 * (distance - radius) / approach;
  return length > 0.0 && length < 0.25 ? length : 0.25;
}

/// [m per leg] How fast the distance of a link's core and a face falls. To first order, it is the
/// difference of the velocities of both closest points along the normal.
double closing_speed(const Instant& now, const RigidMotion& link, const FaceMotion& face) {
  const Vector3d displacement = link.end().translation() - link.start().translation();
  const Vector3d origin = link.start().translation() + now.time * displacement;
  const Vector3d arm = now.closest.on_core - origin;
  const Vector3d of_core = displacement + link.angle() * link.axis().cross(arm);
  const Triangle velocities = {face.end[0] - face.start[0], face.end[1] - face.start[1],
                               face.end[2] - face.start[2]};
  return now.normal.dot(of_core - point_at(velocities, now.closest.barycentric));
}

/// Predicts, by Newton's method, the time at which a link touches. The next interval of the search
/// should end just before the touch: it is then clear as a whole. If it ends after the touch, core
/// and face meet at its end, and no direction for a turning plane is defined there. The prediction
/// is therefore shortened by as much as the last prediction was wrong.
class TouchAim {
 public:
  /// `touching` [m] is the distance that counts as a touch.
  TouchAim(const RigidMotion& link, const FaceMotion& face, double radius, double touching)
      : link_(link), face_(face), radius_(radius), least_target_(0.5 * (touching - radius)) {}

  /// How much later than `now` the next interval should end; infinite if core and face do not
  /// approach.
  double ahead_of(const Instant& now) {
    gap_ = now.closest.distance - radius_;
    speed_ = closing_speed(now, link_, face_);
    if (!(speed_ > 0.0)) return std::numeric_limits<double>::infinity();
    return (gap_ - std::max(shortfall_ * gap_, least_target_)) / speed_;
  }

  /// Learns from `distance`, which was found at the time `after` behind the last instant.
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
  double gap_ = 0.0;                    ///< [m] distance minus the radius, at the last instant
  double speed_ = 0.0;                  ///< [m per leg] closing speed at the last instant
  double shortfall_ = 0.1;              ///< [1] how much of the gap the aim leaves
};

}  // namespace

std::optional<ClosestPoints> triangle_crossing(const Triangle& core, const Triangle& face) {
  const Vector3d core_normal = twice_area(core), face_normal = twice_area(face);
  const Vector3d of_core = heights(core, face_normal, face[0]);
  if (is_on_one_side(of_core)) return std::nullopt;
  const Vector3d of_face = heights(face, core_normal, core[0]);
  if (is_on_one_side(of_face)) return std::nullopt;

  const Vector3d direction = core_normal.cross(face_normal);
  const Section a = cut(core, of_core, direction, face[0]);
  const Section b = cut(face, of_face, direction, face[0]);
  const double begin = std::max(a[0].along, b[0].along), end = std::min(a[1].along, b[1].along);
  if (begin > end) return std::nullopt;
  const double middle = 0.5 * (begin + end);
  const double place = place_at(b, middle);
  ClosestPoints common{0.0, 0.0, barycentric_at(b, place), point_on(a, place_at(a, middle)),
                       {},  {}};
  common.on_face = point_at(face, common.barycentric);
  common.separation = common.on_face - common.on_core;
  common.distance = common.separation.norm();
  common.steps = 1;
  if (!(common.distance <= tolerance::kTie)) return std::nullopt;
  return common;
}

std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      WorkBudget& budget, double until) {
  constexpr int kMaxAdvances = 1000;  // About ten advances are needed.
  if (budget.is_used_up() && !core.start().is_axis()) {
    // Points of core and face that need not be the nearest ones. So no iteration is needed.
    return FirstTouch{0.0, axis_closest_points(core.start().axis(), face.start), false};
  }

  const double farthest_move = core.farthest_move() + face.farthest_move();
  const double out_of_reach = radius + farthest_move;
  // Triangles that touch when a leg begins mostly cross each other, so the quick test for a
  // crossing is tried first.
  std::optional<ClosestPoints> crossing;
  if (core.start().is_triangle()) crossing = triangle_crossing(core.start().triangle(), face.start);
  const ClosestPoints at_start =
      crossing ? *crossing : closest_points(core.start(), face.start, out_of_reach);
  budget.spend(at_start.steps);
  if (at_start.distance <= radius) return FirstTouch{0.0, at_start};
  if (at_start.distance > out_of_reach || until == 0.0) return std::nullopt;
  Instant now(0.0, core, face, at_start);
  // [m] The largest distance that counts as a touch.
  const double touching =
      radius + tolerance::kTouch +
      tolerance::kRounding * std::max(core.largest_coordinate(), face.largest_coordinate());
  if (FixedPlane(now.normal, core).keeps_beyond(face, touching)) return std::nullopt;

  // Before this time has passed, nothing can touch, because nothing moves that fast. The search
  // thus advances even where the nearest points are too close to each other to give a reliable
  // normal.
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
