#include "force_limit.hpp"

#include <Eigen/Core>

namespace organ_collision {

bool limit_force(std::vector<FaceForce>& forces, double max_force) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const FaceForce& at : forces) sum += at.force;
  const double magnitude = sum.stableNorm();
  if (magnitude <= max_force) return false;
  for (FaceForce& at : forces) at.force *= max_force / magnitude;
  return true;
}

}  // namespace organ_collision
