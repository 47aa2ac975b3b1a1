#include "moving_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d longest_edge(const Triangle& face) {
  const Vector3d edges[] = {face[1] - face[0], face[2] - face[1], face[0] - face[2]};
  return *std::max_element(std::begin(edges), std::end(edges), [](const auto& a, const auto& b) {
    return a.squaredNorm() < b.squaredNorm();
  });
}

/// The unit normal of a face by the right-hand rule; zero if the face is degenerate.
Vector3d face_normal(const Triangle& face) {
  const Vector3d normal = twice_area(face);
  const double length = normal.norm();
  if (!(length > tolerance::kParallel * longest_edge(face).squaredNorm())) return Vector3d::Zero();
  return normal / length;
}

/// A unit vector perpendicular to both vectors. If they are parallel or one of them is zero, the
/// result is perpendicular to the longer one. If both are zero, it is the x axis.
Vector3d perpendicular(const Vector3d& a, const Vector3d& b) {
  const Vector3d across = a.cross(b);
  if (across.norm() > tolerance::kParallel * a.norm() * b.norm()) return across.normalized();
  const Vector3d& direction = a.squaredNorm() > b.squaredNorm() ? a : b;
  Eigen::Index least = 0;
  direction.cwiseAbs().minCoeff(&least);
  return direction.squaredNorm() > 0.0
             ? direction.cross(Vector3d(Vector3d::Unit(least))).normalized()
             : Vector3d(Vector3d::Unit(0));
}

bool first_nonzero_is_positive(const Vector3d& v) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (std::abs(v[i]) > tolerance::kParallel) return v[i] > 0.0;
  }
  return true;
}

/// The contact's normal if the axis of a shaft pierces the face: the face's own normal, with the
/// sign for which normal · (tip - trocar) >= 0. See doc/theory/geometry.md, Ties and piercing.
Vector3d piercing_normal(const ShaftAxis& axis, const Triangle& face) {
  const Vector3d direction = axis.along();
  Vector3d normal = face_normal(face);
  if (normal.isZero(0.0)) normal = perpendicular(direction, longest_edge(face));
  const double along = normal.dot(direction);
  const bool in_plane = std::abs(along) <= tolerance::kParallel * direction.norm();
  const bool flip = in_plane ? !first_nonzero_is_positive(normal) : along < 0.0;
  return flip ? Vector3d(-normal) : normal;
}

/// [m] The interval that a link covers along a unit direction, in the organ's frame.
ProjectionInterval project_onto(const Vector3d& direction, const Link& link,
                                const Eigen::Isometry3d& T_organ_link) {
  const Vector3d in_link = T_organ_link.linear().transpose() * direction;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ProjectionInterval covered = {kInfinity, -kInfinity};
  for (const LinkPart& part : link.parts) {
    const ProjectionInterval of_part = part.project_onto(in_link);
    covered.low = std::min(covered.low, of_part.low - part.radius);
    covered.high = std::max(covered.high, of_part.high + part.radius);
  }
  const double place = direction.dot(T_organ_link.translation());
  return {covered.low + place, covered.high + place};
}

}  // namespace

Vector3d MovingPart::separating_normal(const ClosestPoints& closest) const {
  return closest.distance > tolerance::kPierced ? closest.separation.normalized()
                                                : Vector3d(Vector3d::Zero());
}

void MovingPart::find_touches(double radius, WorkBudget& budget, SurfaceTouches& /*memory*/,
                              std::vector<FaceTouch>& faces) const {
  for (FaceTouch& face : faces) face.first = first_touch(core_, face.motion, radius, budget);
}

std::optional<ClosestApproach> MovingPart::closest_approach(const FaceMotion& face,
                                                            double distance_bound,
                                                            WorkBudget& budget) const {
  return organ_collision::closest_approach(core_, face, distance_bound, budget);
}

std::optional<ClosestPoints> MovingPart::closest_at_start(const Triangle& face,
                                                          double bound) const {
  return closest_points(core_.start(), face, bound);
}

FaceContact MovingPart::contact(const FirstTouch& touch, const FaceMotion& face,
                                const Triangle& face_at_end) const {
  const ClosestPoints& closest = touch.closest;
  const Vector3d core_end = at_end(touch);

  FaceContact contact;
  contact.link = link_;
  contact.is_resolved = touch.is_resolved;
  contact.point = closest.on_face;
  contact.barycentric = closest.barycentric;
  contact.on_organ = point_at(face_at_end, closest.barycentric);
  contact.shaft = link_ == kShaft ? closest.shaft : 0.0;
  if (closest.distance <= tolerance::kPierced) {
    const auto [normal, reach_at_end] = piercing(touch.time, face.at(touch.time));
    contact.normal = normal;
    contact.depth = reach_at_end - normal.dot(contact.on_organ);
  } else {
    contact.normal = closest.separation.normalized();
    contact.depth = radius_ - contact.normal.dot(contact.on_organ - core_end);
    // The pair nearest to the tip may be a little farther apart than the pair with the least
    // distance.
    const bool is_tied = -tolerance::kTie < contact.depth && contact.depth < 0.0;
    if (is_tied && closest.distance <= radius_) contact.depth = 0.0;
  }
  contact.behind = face_normal(face_at_end).dot(core_end - contact.on_organ) < -tolerance::kTie;
  return contact;
}

MovingPart::Piercing MovingShaft::piercing(double time, const Triangle& face) const {
  const Vector3d normal = piercing_normal(core().at(time).axis(), face);
  return {normal, normal.dot(end_.tip) + radius()};
}

/// The normal is the face's own one. Two motions across the face part the link from it, forward and
/// backward. The sign is such that the shorter one is along -normal.
MovingPart::Piercing MovingLinkPart::piercing(double time, const Triangle& face) const {
  Vector3d normal = face_normal(face);
  if (normal.isZero(0.0)) normal = perpendicular(longest_edge(face), Vector3d::Zero());
  const Eigen::Isometry3d pose = motion_.at(time);
  ProjectionInterval covered = project_onto(normal, its_link_, pose);
  const double place = normal.dot(face[0]);
  const double forward = covered.high - place, backward = place - covered.low;
  const bool is_tie = std::abs(forward - backward) <= tolerance::kTie;
  const bool flip = is_tie ? !first_nonzero_is_positive(normal) : backward < forward;
  constexpr double kSamePose = 1e-15;  // [1] RigidMotion changes a pose by rounding only
  if (!pose.isApprox(end_, kSamePose)) covered = project_onto(normal, its_link_, end_);
  return flip ? Piercing{-normal, -covered.low} : Piercing{normal, covered.high};
}

Vector3d MovingLinkPart::moved_since(const ToolPose& before, const ClosestPoints& now) const {
  const RigidMotion way(before.links[static_cast<std::size_t>(link())], end_);
  const Vector3d arm = now.on_core - way.end().translation();
  return way.end().translation() - way.start().translation() + way.angle() * way.axis().cross(arm);
}

void MovingSurface::find_touches(double radius, WorkBudget& budget, SurfaceTouches& memory,
                                 std::vector<FaceTouch>& faces) const {
  memory.find(*part_.surface, motion_, radius, budget, faces);
}

std::optional<ClosestApproach> MovingSurface::closest_approach(const FaceMotion& face,
                                                               double distance_bound,
                                                               WorkBudget& budget) const {
  return organ_collision::closest_approach(*part_.surface, motion_, face, distance_bound, budget);
}

std::optional<ClosestPoints> MovingSurface::closest_at_start(const Triangle& face,
                                                             double bound) const {
  WorkBudget budget = WorkBudget::unlimited();
  const auto approach = closest_approach({face, face}, bound, budget);
  return approach ? std::optional(approach->closest) : std::nullopt;
}

PartOnLeg::PartOnLeg(const Step& step, const LegSpan& span, const ToolPart& part) {
  if (part.link == kShaft) {
    part_ = &kind_.emplace<MovingShaft>(step.shaft_motion(span), step.radius(), step.last().axis);
    return;
  }
  const auto number = static_cast<std::size_t>(part.link);
  const Link& link = step.link(number);
  const RigidMotion& motion = motion_.emplace(step.link_motion(span, number));
  const Eigen::Isometry3d& end = step.last().links[number];
  if (part.shape->surface) {
    part_ = &kind_.emplace<MovingSurface>(*part.shape, link, part.link, motion, end);
  } else {
    part_ = &kind_.emplace<MovingLinkPart>(*part.shape, link, part.link, motion, end);
  }
}

FaceContact contact_on(const Step& step, std::size_t leg, const MovingPart& part,
                       std::uint32_t face, const FirstTouch& touch) {
  const FaceIndices& corners = step.organ().faces()[face];
  FaceContact contact = part.contact(touch, step.organ_motion(step.span_of(leg)).face(corners),
                                     step.organ().triangle(corners));
  contact.face = face;
  contact.vertices = corners;
  contact.fraction = step.fraction_at(leg, touch.time);
  return contact;
}

}  // namespace organ_collision
