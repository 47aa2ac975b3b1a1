#include "grasper_robot.hpp"

namespace grasper {

Robot::Robot(const Place& start) : way_{start} {
  message_.name.assign(kJoints.begin(), kJoints.end());
  timer_ = node_.createTimer(ros::Duration(1.0 / kRate),
                             [this](const ros::TimerEvent& event) { go(event.current_real); });
}

void Robot::follow(const Path& way) {
  const std::lock_guard<std::mutex> lock(mutex_);
  way_.assign(way.begin(), way.end());
}

void Robot::go(const ros::Time& now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Joints joints = joints_at(way_.front());
  if (way_.size() > 1) way_.pop_front();
  message_.header.stamp = now;
  message_.position.assign(joints.data(), joints.data() + joints.size());
  publisher_.publish(message_);
}

}  // namespace grasper
