#include "force_limit.hpp"

namespace organ_collision {

double share_within_limit(const Eigen::Vector3d& force, double max_force) {
  const double magnitude = force.stableNorm();
  return magnitude <= max_force ? 1.0 : max_force / magnitude;
}

bool limit_force(std::vector<FaceForce>& forces, double max_force) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const FaceForce& at : forces) sum += at.force;
  const double share = share_within_limit(sum, max_force);
  if (share == 1.0) return false;
  for (FaceForce& at : forces) at.force *= share;
  return true;
}

}  // namespace organ_collision
