#include "tool_sender.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "scripted_tools.hpp"

namespace organ_collision {
namespace {

/// A pose whose z axis points along the shaft.
Eigen::Isometry3d pose_at(const Eigen::Vector3d& place, const Eigen::Vector3d& shaft) {
  Eigen::Isometry3d pose(Eigen::Translation3d{place});
  pose.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), shaft));
  return pose;
}

geometry_msgs::TransformStamped transform(const ros::Time& stamp, const std::string& parent,
                                          const std::string& child,
                                          const Eigen::Isometry3d& T_parent_child) {
  geometry_msgs::TransformStamped result = tf2::eigenToTransform(T_parent_child);
  result.header.stamp = stamp;
  result.header.frame_id = parent;
  result.child_frame_id = child;
  return result;
}

}  // namespace

ToolSender::ToolSender(ros::NodeHandle node, std::string frame) : frame_(std::move(frame)) {
  std::vector<geometry_msgs::TransformStamped> trocars;
  for (const ScriptedTool& tool : scripted_tools()) {
    trocars.push_back(transform(ros::Time::now(), frame_, tool.name + "_trocar",
                                Eigen::Isometry3d(Eigen::Translation3d(tool.trocar))));
    if (!tool.has_proxy) continue;
    hands_[tool.name] = node.advertise<geometry_msgs::PoseStamped>(tool.name + "/hand", 1);
  }
  trocar_broadcaster_.sendTransform(trocars);
}

void ToolSender::send_tips(double seconds, const ros::Time& stamp) {
  std::vector<geometry_msgs::TransformStamped> tips;
  for (const ScriptedTool& tool : scripted_tools()) {
    if (tool.has_proxy) continue;
    const Eigen::Vector3d shaft = tool.tip(seconds) - tool.trocar;
    tips.push_back(
        transform(stamp, tool.name + "_trocar", tool.name + "_tip", pose_at(shaft, shaft)));
  }
  tip_broadcaster_.sendTransform(tips);
}

void ToolSender::send_hands(double seconds, const ros::Time& stamp) {
  for (const ScriptedTool& tool : scripted_tools()) {
    if (!tool.has_proxy) continue;
    const Eigen::Vector3d tip = tool.tip(seconds);
    geometry_msgs::PoseStamped hand;
    hand.header.stamp = stamp;
    hand.header.frame_id = frame_;
    hand.pose = tf2::toMsg(pose_at(tip, tip - tool.trocar));
    hands_.at(tool.name).publish(hand);
  }
}

}  // namespace organ_collision
