#include <ros/ros.h>

#include "mesh_adapter_names.hpp"
#include "organ_mesh_adapter.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, organ_collision::names::kMeshAdapter);
  const ros::NodeHandle node;  // Without any node handle, ROS would not log the error below.
  try {
    organ_collision::OrganMeshAdapter adapter(node, ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
