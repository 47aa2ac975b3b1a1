#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

namespace organ_collision {

// Conversions between messages and Eigen, in the same units. tf2::toMsg() converts points to
// messages.

/// tf2::fromMsg() writes into an argument. These return the value, so that formulas can use it.
Eigen::Vector3d to_eigen(const geometry_msgs::Point& point);
Eigen::Vector3d to_eigen(const geometry_msgs::Vector3& vector);
/// Normalises the rotation, because senders round it. tf2::transformToEigen() does not normalise.
Eigen::Isometry3d to_eigen(const geometry_msgs::Transform& transform);
/// The same for a pose.
Eigen::Isometry3d to_eigen(const geometry_msgs::Pose& pose);

/// Whether the length of a quaternion is 1 to within 1e-3, as senders round it. If not, it is no
/// rotation.
bool is_unit(const geometry_msgs::Quaternion& quaternion);

/// tf2::toMsg() returns a Point unless it is given a Vector3 to write into.
geometry_msgs::Vector3 to_vector(const Eigen::Vector3d& vector);

/// The frame's name for tf2, which accepts no leading slash: "/liver" becomes "liver".
std::string tf_frame(const std::string& frame_id);

}  // namespace organ_collision
