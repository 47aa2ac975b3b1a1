#include "face_force.hpp"

#include <Eigen/Geometry>

#include "ros/interface/conversions.hpp"

namespace organ_collision {

geometry_msgs::Wrench wrench_of(const std::vector<FaceForce>& forces) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
  for (const FaceForce& at : forces) {
    force += at.force;
    torque += at.place.cross(at.force);
  }
  geometry_msgs::Wrench wrench;
  wrench.force = to_vector(force);
  wrench.torque = to_vector(torque);
  return wrench;
}

}  // namespace organ_collision
