#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/Grasp.h>
#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <organ_collision/TouchEvent.h>
#include <visualization_msgs/MarkerArray.h>

#include "collision_node.hpp"
#include "node_core.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

/// scripts/make_reference makes doc/reference/nodes.md of it, and a test compares both.
ProgramHelp node_help() {
  ProgramHelp help = organ_node_help(
      "organ_collision_node",
      "Tells which faces of deforming organs surgical tools touch, or touched since the last "
      "answer. The names below are private to the node (~), whose default name is /" +
          std::string(names::kNode) + ". It is also a nodelet, organ_collision/CollisionNodelet.",
      "forgets all history: the next step of each tool is static");
  help.published = {
      {names::kContacts, message_type<ContactArray>(),
       "what each tool touches, how far it is if it has a margin, and whether it is inside: one "
       "message for each tool and each evaluated shape or pose, also when nothing is touched"},
      {names::kTouches, message_type<TouchEvent>(),
       "when a tool begins to touch an organ, and when it ceases"},
      {names::kGrasps, message_type<Grasp>(),
       "when the jaws of a tool grasp tissue, and when they let it go: its faces and thickness"},
      {names::kMarkers, message_type<visualization_msgs::MarkerArray>(),
       "organs, tools, swept surfaces, contacts, clearances and near faces, for RViz"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "rates, query times, rejected messages by reason, superseded shapes, late transforms, GL "
       "version, scheduling, whether the ROS master lists the node; the organs and tools"}};
  const std::vector<HelpEntry> queries = {
      {names::kQuery, service_type<QueryCollision>(),
       "what one motion, or one of the node's tools, would touch; on request, how far and on which "
       "side it is"},
      {names::kQueryBatch, service_type<QueryCollisionBatch>(),
       "what many motions would touch of one organ, or of all; on request, how far and on which "
       "side the tool is"}};
  help.services.insert(help.services.begin(), queries.begin(), queries.end());
  help.parameters = parameter_help<NodeParameters>();
  help.further =
      "roslaunch organ_collision organ_collision.launch tools:=FILE.yaml starts the node with the "
      "tools of a file. doc/interface.md explains steps, queries, statuses and changes.";
  return help;
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  return run_program(argc, argv, node_help(), names::kNode,
                     [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                       make_ros_realtime(node, private_node);
                       run_collision_node(node, private_node, RunControl());
                     });
}
