#include "organ_collision/query/contact_refiner.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d at(const Vector3d& barycentric, const Triangle& face) {
  return barycentric[0] * face[0] + barycentric[1] * face[1] + barycentric[2] * face[2];
}

Vector3d longest_edge(const Triangle& face) {
  const Vector3d edges[] = {face[1] - face[0], face[2] - face[1], face[0] - face[2]};
  return *std::max_element(std::begin(edges), std::end(edges), [](const auto& a, const auto& b) {
    return a.squaredNorm() < b.squaredNorm();
  });
}

/// The unit face normal by the right-hand rule; zero where the face is degenerate.
Vector3d face_normal(const Triangle& face) {
  const Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]);
  const double length = normal.norm();
  if (!(length > tolerance::kParallel * longest_edge(face).squaredNorm())) return Vector3d::Zero();
  return normal / length;
}

/// A unit vector at right angles to both, or to the one that has a direction.
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
  for (const double component : v) {
    if (std::abs(component) > tolerance::kParallel) return component > 0.0;
  }
  return true;
}

/// The normal where the axis pierces the face: the face's own, turned the tool's way in.
Vector3d piercing_normal(const ShaftAxis& axis, const Triangle& face) {
  const Vector3d direction = axis.tip - axis.trocar;
  Vector3d normal = face_normal(face);
  if (normal.isZero(0.0)) normal = perpendicular(direction, longest_edge(face));
  const double along = normal.dot(direction);
  const bool in_plane = std::abs(along) <= tolerance::kParallel * direction.norm();
  const bool turn = in_plane ? !first_nonzero_is_positive(normal) : along < 0.0;
  return turn ? Vector3d(-normal) : normal;
}

}  // namespace

std::optional<FaceContact> refine(const LegAndEnd& step, double radius) {
  const std::optional<FirstTouch> touch = first_touch(step.shaft, step.face, radius);
  if (!touch) return std::nullopt;
  const ClosestPoints& closest = touch->closest;
  const Vector3d point_end = at(closest.barycentric, step.face_end);
  const Vector3d axis_end = step.shaft_end.at(closest.shaft);

  FaceContact contact;
  contact.fraction = step.begin + touch->time * (step.finish - step.begin);
  contact.point = closest.on_face;
  contact.barycentric = closest.barycentric;
  contact.shaft = closest.shaft;
  if (closest.distance <= tolerance::kPierced) {
    contact.normal = piercing_normal(step.shaft.at(touch->time), step.face.at(touch->time));
    contact.depth = radius + contact.normal.dot(step.shaft_end.tip - point_end);
  } else {
    contact.normal = (closest.on_face - closest.on_core).normalized();
    contact.depth = radius - contact.normal.dot(point_end - axis_end);
  }
  contact.behind = face_normal(step.face_end).dot(axis_end - point_end) < -tolerance::kTie;
  return contact;
}

}  // namespace organ_collision
