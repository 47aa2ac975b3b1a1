#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/ProxyState.h>
#include <organ_collision/VertexForces.h>
#include <ros/names.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <csignal>

#include "haptic_proxy.hpp"
#include "haptic_proxy_parameters.hpp"
#include "node/node_core.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

RunControl control;

/// Replaces the handler of ROS, which would end the topics before the forces have faded. A second
/// signal ends the program at once.
void on_signal(int signal) {
  control.stop = true;
  std::signal(signal, SIG_DFL);
}

/// scripts/make_reference makes doc/reference/nodes.md of it, and a test compares both.
ProgramHelp haptic_proxy_help() {
  const std::string tool = "TOOL", pair = "ORGAN/TOOL";
  ProgramHelp help = organ_node_help(
      names::kHapticProxy,
      "Gives each tool a proxy that follows the hand but stops at tissue, and the force of a "
      "spring between both, within max_force and max_torque. The names below are private to the "
      "node (~), whose default name is /" +
          std::string(names::kHapticProxy) +
          ". It is also a nodelet, organ_collision/HapticProxyNodelet. " + kPairNamesHelp,
      "places all proxies anew");
  help.published = {
      {ros::names::append(tool, names::kProxy), message_type<geometry_msgs::PoseStamped>(),
       "where the proxy is: the tip of a shaft, with the z axis from trocar to tip, or the first "
       "link of a tool without a shaft. Not sent without an answer"},
      {ros::names::append(tool, names::kState), message_type<ProxyState>(),
       "what the proxy does, the whole wrench on the hand, the places that hold the proxy or are "
       "near it, and why there is no answer"},
      {ros::names::append(tool, names::kWrench), message_type<geometry_msgs::WrenchStamped>(),
       "force of all organs on the tool [N], torque about the origin of its tip frame [N m], in "
       "the "
       "axes of this frame. A tool without a tip frame: in the frame of its first link"},
      {ros::names::append(pair, names::kWrench), message_type<geometry_msgs::WrenchStamped>(),
       "force of the organ on the hand [N], torque about the origin of the proxy's frame [N m]. In "
       "the proxy's frame for all organs: their sum is the wrench of the state, also while it "
       "fades"},
      {ros::names::append(pair, names::kVertexForces), message_type<VertexForces>(),
       "forces of the proxy on the tissue's vertices [N], in the organ's frame. Of a free tool, "
       "they add up to minus the wrench, unless the state is fading: tissue that the tool has left "
       "is free at once. For a tool with `lockstep`, sent once for each shape of the organ"},
      {names::kMarkers, message_type<visualization_msgs::MarkerArray>(),
       "hands, proxies, forces, states and organs, for RViz"},
      {"/tf", message_type<tf2_msgs::TFMessage>(), "where the proxies are: the frames TOOL_proxy"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "times of ticks, what had no answer, clipped forces, refused messages, what became of organ "
       "messages"}};
  help.parameters = parameter_help<HapticProxyParameters>();
  help.further =
      "roslaunch organ_collision haptic_proxy.launch tools:=FILE.yaml starts the node with the "
      "tools of a file. doc/haptics.md explains what the proxy does, and how to use it safely; "
      "doc/forces.md is for tools that a simulator moves.";
  return help;
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  return run_program(
      argc, argv, haptic_proxy_help(), names::kHapticProxy,
      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
        for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, on_signal);
        make_ros_realtime(node, private_node);
        run_haptic_proxy(node, private_node, control);
      },
      ros::init_options::NoSigintHandler);
}
