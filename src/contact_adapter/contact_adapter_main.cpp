#include <ros/ros.h>

#include "contact_adapter.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "contact_adapter");
  const ros::NodeHandle node;  // Without any node handle, ROS would not log the error below.
  try {
    organ_collision::ContactAdapter adapter(node, ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
