#include "force_limit.hpp"

#include <Eigen/Core>

#include "ros/interface/conversions.hpp"

namespace organ_collision {

bool limit_force(geometry_msgs::Wrench& wrench, double max_force) {
  const Eigen::Vector3d force = to_eigen(wrench.force);
  const Eigen::Vector3d torque = to_eigen(wrench.torque);
  const double magnitude = force.stableNorm();
  if (magnitude <= max_force) return false;
  wrench.force = to_vector(max_force / magnitude * force);
  wrench.torque = to_vector(max_force / magnitude * torque);
  return true;
}

}  // namespace organ_collision
