#include "force_limit.hpp"

namespace organ_collision {

double share_within_limit(const Eigen::Vector3d& load, double most) {
  const double magnitude = load.stableNorm();
  return magnitude <= most ? 1.0 : most / magnitude;
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
