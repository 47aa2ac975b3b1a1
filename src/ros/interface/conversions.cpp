#include "conversions.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <cmath>

namespace organ_collision {

Eigen::Vector3d to_eigen(const geometry_msgs::Point& point) {
  Eigen::Vector3d result;
  tf2::fromMsg(point, result);
  return result;
}

Eigen::Vector3d to_eigen(const geometry_msgs::Vector3& vector) {
  Eigen::Vector3d result;
  tf2::fromMsg(vector, result);
  return result;
}

Eigen::Isometry3d to_eigen(const geometry_msgs::Transform& transform) {
  Eigen::Quaterniond rotation;
  tf2::fromMsg(transform.rotation, rotation);
  return Eigen::Translation3d(to_eigen(transform.translation)) * rotation.normalized();
}

Eigen::Isometry3d to_eigen(const geometry_msgs::Pose& pose) {
  Eigen::Quaterniond rotation;
  tf2::fromMsg(pose.orientation, rotation);
  return Eigen::Translation3d(to_eigen(pose.position)) * rotation.normalized();
}

bool is_unit(const geometry_msgs::Quaternion& quaternion) {
  constexpr double kTolerance = 1e-3;
  Eigen::Quaterniond rotation;
  tf2::fromMsg(quaternion, rotation);
  return std::abs(rotation.norm() - 1.0) <= kTolerance;
}

geometry_msgs::Vector3 to_vector(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  return tf2::toMsg(vector, message);
}

std::string tf_frame(const std::string& frame_id) {
  return frame_id.empty() || frame_id.front() != '/' ? frame_id : frame_id.substr(1);
}

}  // namespace organ_collision
