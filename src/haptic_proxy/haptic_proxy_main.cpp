#include <ros/ros.h>

#include "haptic_proxy_help.hpp"
#include "haptic_proxy_names.hpp"
#include "haptic_proxy_node.hpp"

int main(int argc, char** argv) {
  using namespace organ_collision;
  if (const auto exit_code = answer_arguments(argc, argv, haptic_proxy_help())) return *exit_code;
  ros::init(argc, argv, names::kHapticProxy);
  const ros::NodeHandle node;  // Without any node handle, ROS_FATAL below would not reach /rosout.
  try {
    HapticProxyNode(node, ros::NodeHandle("~")).run();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
