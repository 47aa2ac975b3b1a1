#include "step.hpp"

#include <cmath>
#include <limits>

#include "request_check.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;

/// The joints of a link on the leg to a waypoint.
ChainMotion joints_to(const ToolWaypoint& waypoint, std::size_t link) {
  return waypoint.joints.empty() ? ChainMotion{} : waypoint.joints[link];
}

/// The number of equal parts into which a leg is divided, so that no link, and nothing that carries
/// an end of the shaft's axis, turns by more than kMaxRotation.
int count_parts(const ToolWaypoint& from, const ToolWaypoint& to) {
  double least_cosine = 1.0;
  for (std::size_t i = 0; i < to.links.size(); ++i) {
    // The rotation R between both poses has the trace 1 + 2 cos(angle).
    const double trace = from.links[i].linear().cwiseProduct(to.links[i].linear()).sum();
    least_cosine = std::min(least_cosine, 0.5 * (trace - 1.0));
  }
  double angle = std::max(to.arcs[0].angle(), to.arcs[1].angle());
  for (const ChainMotion& joints : to.joints) angle = std::max(angle, joints.angle());
  if (least_cosine < std::cos(kMaxRotation)) {
    angle = std::max(angle, std::acos(std::max(least_cosine, -1.0)));
  }
  return std::max(1, static_cast<int>(std::ceil(angle / kMaxRotation)));
}

/// Lets a waypoint come from the time `begin` of its leg, and not from the leg's start.
void set_way(ToolWaypoint& waypoint, const ToolWaypoint& to, double begin, double time) {
  waypoint.arcs = {to.arcs[0].part(begin, time), to.arcs[1].part(begin, time)};
  waypoint.joints = to.joints;
  for (ChainMotion& joints : waypoint.joints) joints = joints.part(begin, time);
}

/// The waypoint at `time` in [0, 1] of a leg. It comes from the one at the time `begin`.
ToolWaypoint interpolated(const ToolWaypoint& from, const ToolWaypoint& to, double begin,
                          double time) {
  ToolWaypoint waypoint{from.fraction + time * (to.fraction - from.fraction),
                        ShaftMotion{from.axis, to.axis, to.arcs}.at(time)};
  set_way(waypoint, to, begin, time);
  for (std::size_t i = 0; i < to.links.size(); ++i) {
    waypoint.links.push_back(RigidMotion(from.links[i], to.links[i], joints_to(to, i)).at(time));
  }
  return waypoint;
}

// [1] The largest deviation of a span, as a share of the thickness of the shaft or link.
constexpr double kAllowedShare = 0.25;

/// [1] The poses of a request are rotations only to kRotationTolerance, but legs are evaluated with
/// the nearest rotation. At a distance of 1, both may differ by this much. See
/// doc/theory/geometry.md, Spans of legs.
constexpr double kOffRotation = 2.5 * kRotationTolerance;

constexpr double kTooFar = std::numeric_limits<double>::infinity();

/// [m] How far a link may deviate from its chord: a share of the thickness of its thinnest part.
/// With a larger deviation, the volume around the chord would be much larger than the volumes
/// around the legs.
double allowed_deviation(const Link& link) {
  double thickness = kTooFar;
  for (const LinkPart& part : link.parts) {
    Eigen::Vector3d half = part.bounds.half_size;
    std::sort(half.data(), half.data() + half.size());
    thickness = std::min(thickness, half[1] + part.radius);
  }
  return kAllowedShare * thickness;
}

/// [1] The chord of the rotation between two orientations: 2 sin(angle / 2). A point at the
/// distance r from the axis of rotation moves by r times this chord.
double rotation_chord(const Isometry3d& from, const Isometry3d& to) {
  return (to.linear() - from.linear()).norm() / std::sqrt(2.0);
}

/// The time on the chord, in [0, 1], of waypoint `i`.
double time_on_chord(const ToolWaypoint* waypoints, std::size_t begin, std::size_t i,
                     std::size_t end) {
  return (waypoints[i].fraction - waypoints[begin].fraction) /
         (waypoints[end].fraction - waypoints[begin].fraction);
}

/// [m] An upper bound of the deviation of the shaft's axis from the chord between waypoints `begin`
/// and `end`; kTooFar if it exceeds `allowed`. Between waypoints, legs on arcs leave the straight
/// line.
double shaft_deviation(const ToolWaypoint* waypoints, std::size_t begin, std::size_t end,
                       double allowed) {
  const ShaftMotion chord{waypoints[begin].axis, waypoints[end].axis};
  double deviation = 0.0, between = 0.0;
  for (std::size_t i = begin + 1; i <= end; ++i) {
    const ShaftArcs& arcs = waypoints[i].arcs;
    between = std::max({between, arcs[0].deviation(), arcs[1].deviation()});
    const ShaftAxis& axis = waypoints[i].axis;
    const ShaftAxis on_chord = chord.at(time_on_chord(waypoints, begin, i, end));
    deviation = std::max(
        {deviation, (axis.trocar - on_chord.trocar).norm(), (axis.tip - on_chord.tip).norm()});
    if (deviation + between > allowed) return kTooFar;
  }
  return deviation + between;
}

/// [m] An upper bound of the deviation of a link from the chord between two waypoints; kTooFar if
/// it exceeds `allowed`. At each waypoint, it is the deviation of the ball. Between waypoints, the
/// leg and the chord each leave a straight line. See doc/theory/geometry.md, Rims and chord
/// deviation.
double link_deviation(const ToolWaypoint* waypoints, std::size_t begin, std::size_t end,
                      std::size_t link, const LinkBall& ball, double allowed) {
  const Isometry3d& first = waypoints[begin].links[link];
  const Isometry3d& last = waypoints[end].links[link];
  if (rotation_chord(first, last) > kMaxRotation) return kTooFar;
  const RigidMotion chord(first, last);
  const double arm = ball.center.norm() + ball.radius;
  double at_waypoints = 0.0, between = 0.0, time = 0.0;
  for (std::size_t i = begin + 1; i <= end; ++i) {
    const Isometry3d& pose = waypoints[i].links[link];
    const double next_time = time_on_chord(waypoints, begin, i, end);
    const Isometry3d on_chord = chord.at(next_time);
    at_waypoints = std::max(at_waypoints, (pose * ball.center - on_chord * ball.center).norm() +
                                              ball.radius * rotation_chord(pose, on_chord));
    // An angle of at most pi is at most pi / 2 times its rotation_chord().
    const ChainMotion joints = joints_to(waypoints[i], link);
    const double leg_angle = M_PI_2 * rotation_chord(waypoints[i - 1].links[link], pose);
    const double chord_angle = chord.angle() * (next_time - time);
    const double on_leg = joints.chain ? joints.bounds(ball.center, ball.radius).deviation
                                       : arm * leg_angle * leg_angle / 8.0;
    between = std::max(between, on_leg + arm * chord_angle * chord_angle / 8.0);
    time = next_time;
    if (at_waypoints + between > allowed) return kTooFar;
  }
  return at_waypoints + between + kOffRotation * arm;
}

/// The span from leg `begin` on. Tries all remaining legs first, then half of them, and so on.
template <typename Deviation>
LegSpan longest_span(std::size_t count, std::size_t begin, Deviation deviation) {
  for (std::size_t legs = count > 1 ? count - 1 - begin : 1; legs > 1; legs /= 2) {
    const double found = deviation(begin, begin + legs);
    if (found < kTooFar) return {begin, begin + legs, found};
  }
  return {begin, begin + 1, 0.0};
}

}  // namespace

const ToolPath& with_subdivided_rotations(const ToolPath& path, ToolPath& finer) {
  const auto is_too_far = [](const ToolWaypoint& from, const ToolWaypoint& to) {
    return count_parts(from, to) > 1;
  };
  if (std::adjacent_find(path.begin(), path.end(), is_too_far) == path.end()) return path;
  finer = {path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const ToolWaypoint &from = path[i - 1], &to = path[i];
    const int parts = count_parts(from, to);
    double begin = 0.0;
    for (int part = 1; part < parts; ++part) {
      const double end = static_cast<double>(part) / parts;
      finer.push_back(interpolated(from, to, begin, end));
      begin = end;
    }
    finer.push_back(to);
    set_way(finer.back(), to, begin, 1.0);
  }
  return finer;
}

LinkBall ball_around(const Link& link) {
  Eigen::AlignedBox3d box;
  for (const LinkPart& part : link.parts) box.extend(part.bounds.center);
  LinkBall ball{box.center(), 0.0};
  for (const LinkPart& part : link.parts) {
    ball.radius = std::max(
        ball.radius, (part.bounds.center - ball.center).norm() + part.bounds.half_size.norm());
  }
  return ball;
}

LegSpan shaft_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                   double allowed) {
  return longest_span(count, begin, [&](std::size_t first, std::size_t last) {
    return shaft_deviation(waypoints, first, last, allowed);
  });
}

LegSpan link_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                  std::size_t link, const LinkBall& ball, double allowed) {
  return longest_span(count, begin, [&](std::size_t first, std::size_t last) {
    return link_deviation(waypoints, first, last, link, ball, allowed);
  });
}

Step::Step(const CollisionRequest& request, const ToolPath& path, BlockBoxes& boxes)
    : organ_(*request.organ),
      organ_before_(request.mode == QueryMode::kStatic ? nullptr : request.organ_before),
      radius_(request.radius),
      links_(request.links),
      waypoints_(request.mode == QueryMode::kStatic ? &path.back() : path.data()),
      waypoint_count_(request.mode == QueryMode::kStatic ? 1 : path.size()) {
  if (!organ_before_) return;
  boxes_before_ = &organ_before_->block_boxes();
  if (&organ_before_->clusters() != &organ_.clusters()) {
    boxes.refit(organ_.clusters(), organ_before_->vertices());
    boxes_before_ = &boxes;
  }
}

LegSpan Step::shaft_span(std::size_t leg) const {
  return organ_collision::shaft_span(waypoints_, waypoint_count_, leg, kAllowedShare * radius_);
}

LegSpan Step::link_span(std::size_t leg, std::size_t link, const LinkBall& ball) const {
  return organ_collision::link_span(waypoints_, waypoint_count_, leg, link, ball,
                                    allowed_deviation((*links_)[link]));
}

std::size_t Step::leg_at(double fraction) const { return leg_at({0, leg_count(), 0.0}, fraction); }

std::size_t Step::leg_at(const LegSpan& span, double time) const {
  const double fraction = begin(span) + time * (finish(span) - begin(span));
  const ToolWaypoint* const ends = waypoints_ + 1;
  const auto next = std::lower_bound(
      ends + span.begin, ends + span.end - 1, fraction,
      [](const ToolWaypoint& waypoint, double value) { return waypoint.fraction < value; });
  return static_cast<std::size_t>(next - ends);
}

OrganMotion Step::organ_motion(const LegSpan& span) const {
  if (!organ_before_) return OrganMotion(organ_);
  return {*organ_before_, *boxes_before_, organ_, begin(span), finish(span)};
}

Eigen::Vector3d velocity_between(const TriangleMesh& from, const TriangleMesh& to, double seconds,
                                 std::uint32_t face, const Eigen::Vector3d& barycentric) {
  return (point_at(to.triangle(face), barycentric) - point_at(from.triangle(face), barycentric)) /
         seconds;
}

Eigen::Vector3d tissue_velocity(const CollisionRequest& request, std::uint32_t face,
                                const Eigen::Vector3d& barycentric) {
  if (!request.velocity_from) return Eigen::Vector3d::Zero();
  return velocity_between(*request.velocity_from, *request.organ, request.velocity_sec, face,
                          barycentric);
}

}  // namespace organ_collision
