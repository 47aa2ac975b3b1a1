#include "contact_refiner.hpp"

#include <Eigen/Geometry>
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
  const Vector3d direction = axis.tip - axis.trocar;
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

struct Piercing {
  Vector3d normal;
  /// [m] How far the tool reaches along the normal at the end of the step: the greatest normal ·
  /// point of the link, or of the ball around the tip.
  double reach_at_end;
};

/// The normal and the reach of a part that pierces a face. `face` is the face at the time `time` of
/// the leg.
Piercing piercing(const PartLeg& part, double time, const Triangle& face) {
  if (!part.end.link) {
    const Vector3d normal = piercing_normal(part.core.at(time).axis(), face);
    return {normal, normal.dot(part.end.axis.tip) + part.radius};
  }
  // The face's own normal. Two motions across the face part the link from it, forward and backward.
  // The sign is such that the shorter one is along -normal.
  Vector3d normal = face_normal(face);
  if (normal.isZero(0.0)) normal = perpendicular(longest_edge(face), Vector3d::Zero());
  const Eigen::Isometry3d pose = part.core.link()->at(time);
  ProjectionInterval covered = project_onto(normal, *part.end.link, pose);
  const double place = normal.dot(face[0]);
  const double forward = covered.high - place, backward = place - covered.low;
  const bool is_tie = std::abs(forward - backward) <= tolerance::kTie;
  const bool flip = is_tie ? !first_nonzero_is_positive(normal) : backward < forward;
  constexpr double kSamePose = 1e-15;  // [1] RigidMotion changes a pose by rounding only
  if (!pose.isApprox(part.end.pose, kSamePose)) {
    covered = project_onto(normal, *part.end.link, part.end.pose);
  }
  return flip ? Piercing{-normal, -covered.low} : Piercing{normal, covered.high};
}

/// The point of the core that touched, where it is at the end of the step.
Vector3d at_end(const FirstTouch& touch, const PartLeg& part) {
  if (!part.end.link) return part.end.axis.at(touch.closest.shaft);
  const Eigen::Isometry3d pose = part.core.link()->at(touch.time);
  return part.end.pose * (pose.inverse() * touch.closest.on_core);
}

}  // namespace

FaceContact contact_of(const FirstTouch& touch, const PartLeg& part, const FaceLeg& face) {
  const ClosestPoints& closest = touch.closest;
  const Vector3d core_end = at_end(touch, part);

  FaceContact contact;
  contact.link = part.link;
  contact.is_resolved = touch.is_resolved;
  contact.fraction = face.begin + touch.time * (face.finish - face.begin);
  contact.point = closest.on_face;
  contact.barycentric = closest.barycentric;
  contact.on_organ = point_at(face.end, closest.barycentric);
  contact.shaft = part.end.link ? 0.0 : closest.shaft;
  if (closest.distance <= tolerance::kPierced) {
    const auto [normal, reach_at_end] = piercing(part, touch.time, face.motion.at(touch.time));
    contact.normal = normal;
    contact.depth = reach_at_end - normal.dot(contact.on_organ);
  } else {
    contact.normal = closest.separation.normalized();
    contact.depth = part.radius - contact.normal.dot(contact.on_organ - core_end);
    // The pair nearest to the tip may be a little farther apart than the pair with the least
    // distance.
    const bool is_tied = -tolerance::kTie < contact.depth && contact.depth < 0.0;
    if (is_tied && closest.distance <= part.radius) contact.depth = 0.0;
  }
  contact.behind = face_normal(face.end).dot(core_end - contact.on_organ) < -tolerance::kTie;
  return contact;
}

}  // namespace organ_collision
