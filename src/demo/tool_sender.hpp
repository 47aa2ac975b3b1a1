#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <map>
#include <string>

namespace organ_collision {

/// Tells other nodes where the scripted tools are, in the liver's frame. The z axis of a tip points
/// along the shaft.
class ToolSender {
 public:
  /// Sends the trocars on /tf_static. `frame`: the liver's.
  ToolSender(ros::NodeHandle node, std::string frame);

  /// Sends the tips of the tools without a hand on /tf, at `seconds` since the start.
  void send_tips(double seconds, const ros::Time& stamp);
  /// Sends the tip of each tool with a hand on NAME/hand, as the driver of a haptic device does.
  void send_hands(double seconds, const ros::Time& stamp);

 private:
  std::string frame_;
  std::map<std::string, ros::Publisher> hands_;  ///< by tool
  tf2_ros::StaticTransformBroadcaster trocar_broadcaster_;
  tf2_ros::TransformBroadcaster tip_broadcaster_;
};

}  // namespace organ_collision
