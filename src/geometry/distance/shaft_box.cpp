#include "shaft_box.hpp"

#include <Eigen/Geometry>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d unit_or(const Vector3d& vector, const Vector3d& otherwise) {
  const Vector3d unit = vector.stableNormalized();
  return unit.isZero(0.0) ? otherwise : unit;
}

/// Columns: orthonormal, right-handed.
Eigen::Matrix3d axes_of(const ShaftMotion& motion) {
  const ShaftAxis middle = motion.at(0.5);
  const Vector3d along = unit_or(middle.tip - middle.trocar, Vector3d::UnitX());
  const Vector3d step = motion.end.tip - motion.start.tip;
  // Removes the part along the axis twice: the first time leaves a rounding error of it.
  Vector3d across = unit_or(step - along.dot(step) * along, along.unitOrthogonal());
  across = unit_or(across - along.dot(across) * along, along.unitOrthogonal());
  Eigen::Matrix3d axes;
  axes << along, across, along.cross(across);
  return axes;
}

}  // namespace

OrientedBox box_around(const ShaftMotion& motion) {
  const Eigen::Matrix3d axes = axes_of(motion);
  const Vector3d& origin = motion.end.trocar;
  Eigen::AlignedBox3d box;
  for (const ShaftAxis& axis : {motion.start, motion.end}) {
    box.extend(axes.transpose() * (axis.trocar - origin));
    box.extend(axes.transpose() * (axis.tip - origin));
  }
  return {origin + axes * box.center(), axes, 0.5 * box.sizes()};
}

}  // namespace organ_collision
