#include <ros/ros.h>

#include "collision_node.hpp"
#include "node_help.hpp"
#include "organ_collision/ros/names.hpp"
#include "program.hpp"
#include "realtime.hpp"

int main(int argc, char** argv) {
  using namespace organ_collision;
  if (const auto exit_code = answer_arguments(argc, argv, node_help())) return *exit_code;
  ros::init(argc, argv, names::kNode);
  guard_parameter_updates();
  const ros::NodeHandle node;  // Without any node handle, ROS_FATAL below would not reach /rosout.
  const ros::NodeHandle private_node("~");
  try {
    make_ros_realtime(private_node);
    CollisionNode(node, private_node).run();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
