#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/ListTools.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/ProxyState.h>
#include <organ_collision/RemoveOrgan.h>
#include <organ_collision/VertexForces.h>
#include <ros/names.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <atomic>
#include <csignal>

#include "haptic_proxy_node.hpp"
#include "haptic_proxy_parameters.hpp"
#include "organ_collision/ros/names.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

std::atomic<bool> is_to_stop{false};

/// Replaces the handler of ROS, which would end the topics before the forces have faded. A second
/// signal ends the program at once.
void on_signal(int signal) {
  is_to_stop = true;
  std::signal(signal, SIG_DFL);
}

/// doc/haptic_interface.md explains the same names at length; a test compares both.
ProgramHelp haptic_proxy_help() {
  const std::string tool = "~TOOL", pair = "~ORGAN/TOOL";
  std::vector<std::string> live;
  for (const LiveParameter& p : live_parameters(HapticProxyParameters())) live.push_back(p.name);
  ProgramHelp help{names::kHapticProxy,
                   "Gives each tool a proxy that follows the hand but stops at tissue, and the "
                   "force of a spring between both, within max_force and max_torque. The names "
                   "below are private to the "
                   "node (~), whose default name is /" +
                       std::string(names::kHapticProxy) + "."};
  help.subscribed = {
      {names::kOrganMesh, message_type<OrganMesh>(), "an organ's surface: vertices and triangles"},
      {names::kOrganVertices, message_type<OrganVertices>(), "an organ's new shape: its vertices"},
      {"/tf, /tf_static", message_type<tf2_msgs::TFMessage>(), "where the hands and organs are"},
      {"as each tool names it", message_type<geometry_msgs::PoseStamped>(),
       "where the hand holds the tool's tip (tip_pose_topic, base_pose_topic)"}};
  help.published = {
      {ros::names::append(tool, names::kProxy), message_type<geometry_msgs::PoseStamped>(),
       "where the proxy's tip or first link is; also the TF frame TOOL_proxy"},
      {ros::names::append(tool, names::kState), message_type<ProxyState>(),
       "what the proxy does, the whole wrench on the hand, the places that are near, and why there "
       "is "
       "no answer"},
      {ros::names::append(pair, names::kWrench), message_type<geometry_msgs::WrenchStamped>(),
       "force of the organ on the hand [N], torque about the origin of the proxy's frame [N m]"},
      {ros::names::append(pair, names::kVertexForces), message_type<VertexForces>(),
       "forces of the proxy on the tissue's vertices [N]"},
      {names::kMarkers, message_type<visualization_msgs::MarkerArray>(),
       "what RViz shows: hands, proxies, forces, states and organs"},
      {"/tf", message_type<tf2_msgs::TFMessage>(), "the frames TOOL_proxy"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "times of ticks, what had no answer, clipped forces, refused messages"}};
  help.services = {
      {names::kListOrgans, service_type<ListOrgans>(),
       "the organs: faces, box, volume, closed or not"},
      {names::kRemoveOrgan, service_type<RemoveOrgan>(), "removes an organ"},
      {names::kListTools, service_type<ListTools>(), "the tools, and why one cannot be used"},
      {names::kReset, service_type<std_srvs::Empty>(), "places all proxies anew"},
      {names::kReloadTools, service_type<std_srvs::Trigger>(), "reads the parameter tools again"},
      {"set_parameters", service_type<dynamic_reconfigure::Reconfigure>(),
       "changes " + listed(live) + " while the node runs"}};
  help.parameters = parameter_help<HapticProxyParameters>();
  help.tool_keys = tool_keys();
  help.further =
      "roslaunch organ_collision haptic_proxy.launch tools:=FILE.yaml starts the node with the "
      "tools of a file. doc/haptic_interface.md explains all of this.";
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
        make_ros_realtime(node,
                          load_parameters<HapticProxyParameters>(private_node).realtime.priority);
        HapticProxyNode(node, private_node).run([] { return is_to_stop.load(); });
      },
      ros::init_options::NoSigintHandler);
}
