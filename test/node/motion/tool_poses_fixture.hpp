#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <string>

#include "common/messages/conversions.hpp"
#include "node/motion/transform_buffer.hpp"

namespace organ_collision {

/// Looking transforms up needs a clock.
inline const bool kClockIsReady = (ros::Time::init(), true);

inline geometry_msgs::TransformStamped transform_of(const std::string& parent,
                                                    const std::string& child, double time,
                                                    const Eigen::Isometry3d& T_parent_child) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.header.stamp = ros::Time(time);
  message.transform.translation = to_vector(T_parent_child.translation());
  message.transform.rotation = tf2::toMsg(Eigen::Quaterniond(T_parent_child.rotation()));
  return message;
}

/// The pose of a tip or of a base.
inline geometry_msgs::PoseStamped pose_of(const std::string& frame, double time,
                                          const Eigen::Vector3d& point) {
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = frame;
  pose.header.stamp = ros::Time(time);
  pose.pose.position = tf2::toMsg(point);
  pose.pose.orientation.w = 1.0;
  return pose;
}

/// Adds a transform to a TF buffer, as a listener would.
inline void set_transform(TransformBuffer& buffer, const std::string& parent,
                          const std::string& child, double time,
                          const Eigen::Isometry3d& T_parent_child, bool resting = false) {
  buffer.add(transform_of(parent, child, time, T_parent_child), "test", resting);
}

inline void set_point(TransformBuffer& buffer, const std::string& parent, const std::string& child,
                      double time, const Eigen::Vector3d& point, bool resting = false) {
  set_transform(buffer, parent, child, time, Eigen::Isometry3d(Eigen::Translation3d(point)),
                resting);
}

}  // namespace organ_collision
