#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/ListTools.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <organ_collision/RemoveOrgan.h>
#include <organ_collision/TouchEvent.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include "collision_node.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

/// doc/interface.md explains the same names at length; a test compares both.
ProgramHelp node_help() {
  ProgramHelp help;
  help.program = "organ_collision_node";
  help.purpose =
      "Tells which faces of deforming organs surgical tools touch, or touched since the last "
      "answer. The names below are private to the node (~), whose default name is /" +
      std::string(names::kNode) + ".";
  help.subscribed = {
      {names::kOrganMesh, message_type<OrganMesh>(), "an organ's surface: vertices and triangles"},
      {names::kOrganVertices, message_type<OrganVertices>(), "an organ's new shape: its vertices"},
      {"/tf, /tf_static", message_type<tf2_msgs::TFMessage>(), "where tools and organs are"},
      {"as each tool names it", message_type<geometry_msgs::PoseStamped>(),
       "where the tool's tip is (tip_pose_topic, base_pose_topic)"}};
  help.published = {
      {names::kContacts, message_type<ContactArray>(),
       "what each tool touches, how far it is if it has a margin, and whether it is inside; for "
       "each shape or pose"},
      {names::kTouches, message_type<TouchEvent>(),
       "when a tool begins to touch an organ, and when it ceases"},
      {names::kMarkers, message_type<visualization_msgs::MarkerArray>(), "what RViz shows"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "query times, age of meshes, refused messages"}};
  help.services = {
      {names::kQuery, service_type<QueryCollision>(),
       "what one motion, or one tool, would touch; on request, how far and on which side it is"},
      {names::kQueryBatch, service_type<QueryCollisionBatch>(),
       "what many motions would touch; on request, how far and on which side the tool is"},
      {names::kListOrgans, service_type<ListOrgans>(),
       "the organs: faces, box, volume, closed or not"},
      {names::kRemoveOrgan, service_type<RemoveOrgan>(), "removes an organ"},
      {names::kListTools, service_type<ListTools>(), "the tools, and why one cannot be used"},
      {names::kReset, service_type<std_srvs::Empty>(),
       "forgets all history: the next step of each tool is static"},
      {names::kReloadTools, service_type<std_srvs::Trigger>(), "reads the parameter tools again"},
      {"set_parameters", service_type<dynamic_reconfigure::Reconfigure>(),
       "changes parameters while the node runs, as dynparam and rqt_reconfigure do"}};
  help.parameters = parameter_help<NodeParameters>();
  help.tool_keys = tool_keys();
  help.further =
      "roslaunch organ_collision organ_collision.launch tools:=FILE.yaml starts the node with the "
      "tools of a file. doc/interface.md explains all of this.";
  return help;
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  return run_program(argc, argv, node_help(), names::kNode,
                     [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                       make_ros_realtime(
                           node, load_parameters<NodeParameters>(private_node).realtime.priority);
                       CollisionNode(node, private_node).run();
                     });
}
