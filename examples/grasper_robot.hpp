#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include <deque>
#include <mutex>

#include "grasper_places.hpp"

namespace grasper {

inline constexpr double kRate = 100.0;  ///< [Hz] of its joints

/// Publishes the joints of the grasper, which goes along a way and stays at its end.
class Robot {
 public:
  explicit Robot(const Place& start);

  /// `way`: places at intervals of 1 / kRate.
  void follow(const Path& way);

 private:
  void go(const ros::Time& now);

  std::mutex mutex_;
  std::deque<Place> way_;
  sensor_msgs::JointState message_;
  ros::NodeHandle node_;
  ros::Publisher publisher_ = node_.advertise<sensor_msgs::JointState>("joint_states", 10);
  ros::Timer timer_;
};

}  // namespace grasper
