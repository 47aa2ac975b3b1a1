#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <string>

#include "ros/messages/conversions.hpp"
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
  message.transform.translation = to_vector(T_parent_child.translation());
  message.transform.rotation = tf2::toMsg(Eigen::Quaterniond(T_parent_child.rotation()));
  buffer.add(message, "test", resting);
}

inline void set_point(TransformBuffer& buffer, const std::string& parent, const std::string& child,
                      double time, const Eigen::Vector3d& point, bool resting = false) {
  set_transform(buffer, parent, child, time, Eigen::Isometry3d(Eigen::Translation3d(point)),
                resting);
}

}  // namespace organ_collision
