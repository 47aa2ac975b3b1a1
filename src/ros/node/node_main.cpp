#include <ros/ros.h>

#include "collision_node.hpp"
#include "organ_collision/ros/names.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, organ_collision::names::kNode);
  const ros::NodeHandle node;  // Without any node handle, ROS_FATAL below would not reach /rosout.
  try {
    organ_collision::CollisionNode(node, ros::NodeHandle("~")).run();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
