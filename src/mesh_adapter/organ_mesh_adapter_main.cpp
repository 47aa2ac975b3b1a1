#include <ros/ros.h>

#include "organ_mesh_adapter.hpp"

int main(int argc, char** argv) {
  using namespace organ_collision;
  return run_program(argc, argv, mesh_adapter_help(), names::kMeshAdapter,
                     [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                       const OrganMeshAdapter adapter(node, private_node);
                       ros::spin();
                     });
}
