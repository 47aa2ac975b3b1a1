#include "least_rotation.hpp"

namespace organ_collision {

Eigen::Quaterniond least_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace organ_collision
