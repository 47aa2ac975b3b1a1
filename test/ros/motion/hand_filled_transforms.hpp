#pragma once

#include <geometry_msgs/TransformStamped.h>

#include <Eigen/Geometry>
#include <string>

#include "ros/motion/transform_buffer.hpp"

namespace organ_collision {

/// Looking transforms up needs a clock.
inline const bool kClockIsReady = (ros::Time::init(), true);

/// Adds a transform to a TF buffer, as a listener would.
inline void set_transform(TransformBuffer& buffer, const std::string& parent,
                          const std::string& child, double time,
                          const Eigen::Isometry3d& T_parent_child, bool resting = false) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.header.stamp = ros::Time(time);
  message.transform.translation.x = T_parent_child.translation().x();
  message.transform.translation.y = T_parent_child.translation().y();
  message.transform.translation.z = T_parent_child.translation().z();
  const Eigen::Quaterniond turn(T_parent_child.rotation());
  message.transform.rotation.w = turn.w();
  message.transform.rotation.x = turn.x();
  message.transform.rotation.y = turn.y();
  message.transform.rotation.z = turn.z();
  buffer.add(message, "test", resting);
}

inline void set_point(TransformBuffer& buffer, const std::string& parent, const std::string& child,
                      double time, const Eigen::Vector3d& point, bool resting = false) {
  set_transform(buffer, parent, child, time, Eigen::Isometry3d(Eigen::Translation3d(point)),
                resting);
}

}  // namespace organ_collision
