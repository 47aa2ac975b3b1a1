#include <ros/ros.h>

#include "contact_adapter.hpp"

int main(int argc, char** argv) {
  using namespace organ_collision;
  return run_program(argc, argv, contact_adapter_help(), names::kContactAdapter,
                     [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                       const ContactAdapter adapter(node, private_node);
                       ros::spin();
                     });
}
