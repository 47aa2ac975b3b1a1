#include <ros/ros.h>

#include <atomic>
#include <csignal>

#include "haptic_proxy_node.hpp"
#include "haptic_proxy_parameters.hpp"
#include "ros/node/program.hpp"
#include "ros/node/realtime.hpp"

namespace {

std::atomic<bool> is_to_stop{false};

/// ROS would take the topics away before the forces have faded. The second signal ends at once.
void on_signal(int signal) {
  is_to_stop = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace organ_collision;
  if (const auto exit_code = answer_arguments(argc, argv, haptic_proxy_help())) return *exit_code;
  ros::init(argc, argv, names::kHapticProxy, ros::init_options::NoSigintHandler);
  guard_parameter_updates();
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, on_signal);
  const ros::NodeHandle node;  // Without any node handle, ROS_FATAL below would not reach /rosout.
  const ros::NodeHandle private_node("~");
  try {
    make_ros_realtime(private_node);
    HapticProxyNode(node, private_node).run([] { return is_to_stop.load(); });
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
