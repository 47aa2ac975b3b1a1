#include <ros/ros.h>

#include "mesh_adapter_parameters.hpp"
#include "organ_mesh_adapter.hpp"
#include "ros/node/program.hpp"

int main(int argc, char** argv) {
  using namespace organ_collision;
  if (const auto exit_code = answer_arguments(argc, argv, mesh_adapter_help())) return *exit_code;
  ros::init(argc, argv, names::kMeshAdapter);
  guard_parameter_updates();
  const ros::NodeHandle node;  // Without any node handle, ROS would not log the error below.
  try {
    OrganMeshAdapter adapter(node, ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
