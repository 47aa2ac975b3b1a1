#include "node_help.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <organ_collision/RemoveOrgan.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include "organ_collision/ros/names.hpp"
#include "ros/parameters/node_parameters.hpp"

namespace organ_collision {
namespace {

std::vector<HelpEntry> subscribed_topics() {
  return {
      {names::kOrganMesh, message_type<OrganMesh>(), "an organ's surface: vertices and triangles"},
      {names::kOrganVertices, message_type<OrganVertices>(), "an organ's new shape: its vertices"},
      {"/tf, /tf_static", message_type<tf2_msgs::TFMessage>(), "where tools and organs are"},
      {"as each tool names it", message_type<geometry_msgs::PoseStamped>(),
       "where the tool's tip is (tip_pose_topic, base_pose_topic)"},
  };
}

std::vector<HelpEntry> published_topics() {
  return {
      {names::kContacts, message_type<ContactArray>(),
       "what each tool touches, how far it is if it has a margin, and whether it is inside; for "
       "each shape or pose"},
      {names::kMarkers, message_type<visualization_msgs::MarkerArray>(), "what RViz shows"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "query times, age of meshes, refused messages"},
  };
}

std::vector<HelpEntry> services() {
  return {
      {names::kQuery, service_type<QueryCollision>(),
       "what one motion, or one tool, would touch; on request, how far and on which side it is"},
      {names::kQueryBatch, service_type<QueryCollisionBatch>(),
       "what many motions would touch; on request, how far and on which side the tool is"},
      {names::kListOrgans, service_type<ListOrgans>(),
       "the organs: faces, box, volume, closed or not"},
      {names::kRemoveOrgan, service_type<RemoveOrgan>(), "removes an organ"},
      {names::kReset, service_type<std_srvs::Empty>(),
       "forgets all history: the next step of each tool is static"},
      {names::kReloadTools, service_type<std_srvs::Trigger>(), "reads the parameter tools again"},
      {"set_parameters", service_type<dynamic_reconfigure::Reconfigure>(),
       "changes parameters while the node runs, as dynparam and rqt_reconfigure do"},
  };
}

}  // namespace

ProgramHelp node_help() {
  return {"organ_collision_node",
          "Tells which faces of deforming organs surgical tools touch, or touched since the last "
          "answer. The names below are private to the node (~), whose default name is /" +
              std::string(names::kNode) + ".",
          subscribed_topics(),
          published_topics(),
          services(),
          parameter_help(),
          "roslaunch organ_collision organ_collision.launch tools:=FILE.yaml starts the node with "
          "the tools of a file. doc/interface.md explains all of this."};
}

}  // namespace organ_collision
