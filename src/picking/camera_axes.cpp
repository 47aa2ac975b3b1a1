#include "camera_axes.hpp"

#include <Eigen/Geometry>

namespace organ_collision {
namespace {

// Unit, or zero where the vector is.
Eigen::Vector3d direction(const Eigen::Vector3d& vector) { return vector.stableNormalized(); }

}  // namespace

Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view) {
  const Eigen::Vector3d z = direction(view);
  Eigen::Index least_aligned;
  z.cwiseAbs().minCoeff(&least_aligned);
  const Eigen::Vector3d x = Eigen::Vector3d::Unit(least_aligned).cross(z).normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  return axes;
}

Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view, const Eigen::Vector3d& right) {
  const Eigen::Vector3d z = direction(view);
  // Taken twice: what the first subtraction leaves of a nearly parallel vector is rounding.
  Eigen::Vector3d x = direction(right);
  x = direction(x - z * z.dot(x));
  x = direction(x - z * z.dot(x));
  if (x.isZero()) return camera_axes(view);
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  return axes;
}

}  // namespace organ_collision
