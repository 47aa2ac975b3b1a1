#include "swept_box.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace organ_collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d unit_or(const Vector3d& vector, const Vector3d& otherwise) {
  const Vector3d unit = vector.stableNormalized();
  return unit.isZero(0.0) ? otherwise : unit;
}

}  // namespace

SweptBox::SweptBox(const OrientedBox& box, const RigidMotion& motion, double radius)
    : axes_(motion.mid_orientation() * box.axes),
      rests_(motion.rests()),
      start_(place(box, motion.start())),
      end_(rests_ ? start_ : place(box, motion.end())),
      reach_(radius + motion.chord_deviation(box)) {}

SweptBox::Place SweptBox::place(const OrientedBox& box, const Eigen::Isometry3d& pose) const {
  Place place;
  place.center = pose * box.center;
  const Matrix3d axes = rests_ ? axes_ : Matrix3d(pose.linear() * box.axes);
  place.half_edges = axes * box.half_size.asDiagonal();
  const Vector3d center = axes_.transpose() * place.center;
  const Vector3d half = (axes_.transpose() * place.half_edges).cwiseAbs().rowwise().sum();
  place.low = center - half;
  place.high = center + half;
  return place;
}

double SweptBox::clear_until(const LegFace& face, double closer) const {
  const double reach = reach_ - closer;
  double until = 0.0;
  for (int i = 0; i < 3 && until <= 1.0; ++i) {
    until = std::max(until, face.clear_until(axes_.col(i), {start_.low[i], start_.high[i]},
                                             {end_.low[i], end_.high[i]}, reach));
  }
  if (until > 1.0) return until;
  const auto project_box = [&](const Place& box) {
    const double center = face.normal.dot(box.center);
    const double half = (face.normal.transpose() * box.half_edges).cwiseAbs().sum();
    return ProjectionInterval{center - half, center + half};
  };
  const ProjectionInterval of_box = project_box(start_);
  return std::max(
      until, face.clear_until(face.normal, of_box, rests_ ? of_box : project_box(end_), reach));
}

double SweptBox::distance_bound(const FaceMotion& face) const {
  const Vector3d low = this->low(), high = this->high();
  Vector3d gap;
  for (int i = 0; i < 3; ++i) {
    const ProjectionInterval start = project_onto(axes_.col(i), face.start);
    const ProjectionInterval end = project_onto(axes_.col(i), face.end);
    gap[i] = std::max(
        {std::min(start.low, end.low) - high[i], low[i] - std::max(start.high, end.high), 0.0});
  }
  return gap.norm();
}

OrientedBox SweptBox::bounds() const {
  return {axes_ * (0.5 * (low() + high())), axes_, 0.5 * (high() - low())};
}

OrientedBox box_around(const ShaftMotion& motion) {
  const ShaftAxis middle = motion.at(0.5);
  const Vector3d along = unit_or(middle.along(), Vector3d::UnitX());
  const Vector3d step = motion.end.tip - motion.start.tip;
  // Removes the component along the axis twice: the first time leaves a rounding error.
  Vector3d across = unit_or(step - along.dot(step) * along, along.unitOrthogonal());
  across = unit_or(across - along.dot(across) * along, along.unitOrthogonal());
  Matrix3d axes;
  axes << along, across, along.cross(across);
  const Vector3d& origin = motion.end.trocar;
  Eigen::AlignedBox3d box;
  for (const ShaftAxis& axis : {motion.start, motion.end}) {
    box.extend(axes.transpose() * (axis.trocar - origin));
    box.extend(axes.transpose() * (axis.tip - origin));
  }
  const double deviation = motion.deviation();
  return {origin + axes * box.center(), axes, (0.5 * box.sizes()).array() + deviation};
}

}  // namespace organ_collision
