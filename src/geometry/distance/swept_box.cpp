#include "swept_box.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "separating_plane.hpp"

namespace organ_collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [m] The same bound as CoreMotion::chord_deviation(), for any point of the box.
double chord_deviation(const OrientedBox& box, const RigidMotion& motion) {
  if (motion.angle() == 0.0) return 0.0;
  double arm = motion.arm(box.center);
  for (int i = 0; i < 3; ++i) arm += box.half_size[i] * motion.arm(box.axes.col(i));
  return arm * motion.angle() * motion.angle() / 8.0;
}

}  // namespace

SweptBox::SweptBox(const OrientedBox& box, const RigidMotion& motion, double radius)
    : axes_(motion.mid_orientation() * box.axes),
      start_(place(box, motion.start())),
      end_(place(box, motion.end())),
      reach_(radius + chord_deviation(box, motion)) {}

SweptBox::Place SweptBox::place(const OrientedBox& box, const Eigen::Isometry3d& pose) const {
  Place place;
  place.center = pose * box.center;
  const Matrix3d half_edges = pose.linear() * box.axes * box.half_size.asDiagonal();
  const Vector3d center = axes_.transpose() * place.center;
  const Vector3d half = (axes_.transpose() * half_edges).cwiseAbs().rowwise().sum();
  place.low = center - half;
  place.high = center + half;
  return place;
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

}  // namespace organ_collision
