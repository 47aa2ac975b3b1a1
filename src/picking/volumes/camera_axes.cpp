#include "camera_axes.hpp"

#include <Eigen/Geometry>

namespace organ_collision {
namespace {

// [1] A vector counts as parallel to the view below this sine of the angle between them: its part
// at right angles to the view is then only rounding.
constexpr double kParallel = 1e-12;

// The unit vector, or zero for a zero vector.
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
  Eigen::Vector3d x = direction(right);
  x -= z * z.dot(x);
  if (x.norm() < kParallel) return camera_axes(view);
  // This is repeated because the first subtraction cancels most digits of a nearly parallel vector.
  x = direction(x);
  x = direction(x - z * z.dot(x));
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  return axes;
}

}  // namespace organ_collision
