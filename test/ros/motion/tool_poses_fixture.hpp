#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "ros/motion/tool_poses.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

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

inline Tool hook() {
  Tool tool;
  tool.parameters = {"hook", "trocar", "tip", 0.005};
  return tool;
}
const Tool kTool = hook();
const Eigen::Isometry3d kWorldLiver =
    Eigen::Translation3d(0.3, 0.1, -0.4) *
    Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, 2.0, -0.5).normalized());

/// A liver that rests in the world, and a tool whose tip moves on an arc around its trocar.
class ToolPosesTest : public testing::Test {
 protected:
  ToolPosesTest() { set_transform(buffer_, "world", "liver", 0.0, kWorldLiver, true); }

  static Eigen::Vector3d trocar(double time) { return {0.1, 0.2 + 0.01 * time, 0.5}; }
  static Eigen::Vector3d tip(double time) {
    return trocar(time) + 0.3 * Eigen::Vector3d(std::sin(time), 0.2, -std::cos(time));
  }
  static ShaftAxis axis_in_liver(double time) {
    return {kWorldLiver.inverse() * trocar(time), kWorldLiver.inverse() * tip(time)};
  }
  void send_trocar(double time) { set_point(buffer_, "world", "trocar", time, trocar(time)); }
  void send_tip(double time) { set_point(buffer_, "world", "tip", time, tip(time)); }
  void send(double time) {
    send_trocar(time);
    send_tip(time);
  }
  static void expect_axis(const ShaftAxis& axis, const ShaftAxis& expected,
                          double tolerance = 1e-9) {
    EXPECT_LT((axis.trocar - expected.trocar).norm(), tolerance);
    EXPECT_LT((axis.tip - expected.tip).norm(), tolerance);
  }
  Timed<ToolPose> known_pose(double time) const {
    return *poses_.pose(kTool, "liver", ros::Time(time)).found;
  }
  SampledPath path(double from, double to, const PathSampling& sampling) {
    return ToolPoses(buffer_, sampling)
        .path(kTool, "liver", {{axis_in_liver(from)}, ros::Time(from)},
              {{axis_in_liver(to)}, ros::Time(to)});
  }

  TransformBuffer buffer_;
  ToolPoses poses_{buffer_, {0.001, 100}};
};

}  // namespace organ_collision
