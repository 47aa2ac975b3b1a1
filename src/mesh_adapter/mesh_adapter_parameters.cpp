#include "mesh_adapter_parameters.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <pcl_msgs/PolygonMesh.h>
#include <ros/names.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>
#include <visualization_msgs/Marker.h>

#include <set>

#include "organ_collision/ros/names.hpp"
#include "ros/messages/conversions.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

/// A legal ROS name of a topic or node. A private name is refused, because it would be in this
/// adapter's namespace.
std::string graph_name(const ParameterGroup& group, const char* name) {
  std::string text = group.text(name);
  std::string error;
  if (text.front() == '~' || !ros::names::validate(text, error)) {
    group.refuse(name, "must be a name of the ROS graph that is not private" +
                           (error.empty() ? error : ": " + error));
  }
  return text;
}

OrganParameters parse_organ(const ParameterGroup& group) {
  OrganParameters organ;
  organ.name = group.text(names::kOrganName);
  group.check_name(names::kOrganName, organ.name);
  organ.topic = graph_name(group, names::kTopic);
  if (group.has(names::kFrame)) {
    organ.frame = tf_frame(group.text(names::kFrame));
    if (organ.frame.empty()) group.refuse(names::kFrame, "must be the name of a TF frame");
    group.check_name(names::kFrame, organ.frame);
  }
  if (group.has(names::kVerticesTopic)) {
    organ.vertices_topic = graph_name(group, names::kVerticesTopic);
  }
  return organ;
}

void parse_organs(const ParameterGroup& all, MeshAdapterParameters& parameters) {
  const XmlRpcValue& list =
      all.list(names::kOrgans, "groups of name, topic and, if needed, frame and vertices_topic");
  std::set<std::string> organs, topics;
  for (int i = 0; i < list.size(); ++i) {
    const ParameterGroup group(
        all.path_of(names::kOrgans) + "[" + std::to_string(i) + "]", list[i],
        {names::kOrganName, names::kTopic, names::kFrame, names::kVerticesTopic});
    const OrganParameters organ = parse_organ(group);
    if (!organs.insert(organ.name).second) {
      group.refuse(names::kOrganName, "must be unique among the organs");
    }
    if (!topics.insert(organ.topic).second) {
      group.refuse(names::kTopic, "must be unique among all topics of the organs");
    }
    if (!organ.vertices_topic.empty() && !topics.insert(organ.vertices_topic).second) {
      group.refuse(names::kVerticesTopic, "must be unique among all topics of the organs");
    }
    parameters.organs.push_back(organ);
    for (std::string& sentence : group.misspelt()) {
      parameters.misspelt.push_back(std::move(sentence));
    }
  }
}

}  // namespace

MeshAdapterParameters parse_mesh_adapter_parameters(const XmlRpcValue& private_namespace) {
  const ParameterGroup all("~", private_namespace,
                           {names::kOrgans, names::kCollisionNode, names::kDiagnosticPeriod});
  MeshAdapterParameters parameters;
  parameters.misspelt = all.misspelt();
  parse_organs(all, parameters);
  if (all.has(names::kCollisionNode)) {
    parameters.collision_node = graph_name(all, names::kCollisionNode);
  }
  parameters.diagnostic_period_sec =
      all.number(names::kDiagnosticPeriod, parameters.diagnostic_period_sec, kTimerPeriod);
  return parameters;
}

MeshAdapterParameters load_mesh_adapter_parameters(const ros::NodeHandle& private_node) {
  return parse_mesh_adapter_parameters(all_parameters(private_node));
}

ProgramHelp mesh_adapter_help() {
  const MeshAdapterParameters defaults;
  ProgramHelp help{names::kMeshAdapter,
                   "Turns meshes of other message types into organs of the collision node."};
  help.subscribed = {
      {names::kTopic, message_type<shape_msgs::Mesh>(),
       "of each organ; has no header: needs frame"},
      {names::kTopic, message_type<pcl_msgs::PolygonMesh>(), "of each organ; polygons become fans"},
      {names::kTopic, message_type<visualization_msgs::Marker>(), "of each organ; a TRIANGLE_LIST"},
      {names::kVerticesTopic, message_type<sensor_msgs::PointCloud2>(),
       "of each organ that names it: as many points as the mesh has vertices"}};
  help.published = {{ros::names::append(names::kNode, names::kOrganMesh), message_type<OrganMesh>(),
                     "surfaces with new triangles"},
                    {ros::names::append(names::kNode, names::kOrganVertices),
                     message_type<OrganVertices>(), "surfaces with known triangles"},
                    {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
                     "messages of each organ: received, converted, refused by reason, age"}};
  help.parameters = {
      {names::kOrgans, "required",
       "list of organs. Each has name and topic and, if needed, frame and vertices_topic"},
      {names::kCollisionNode, defaults.collision_node, "the collision node, which gets the organs"},
      {names::kDiagnosticPeriod, shown(defaults.diagnostic_period_sec),
       "[s] between messages on /diagnostics"}};
  help.further =
      "roslaunch organ_collision organ_mesh_adapter.launch organs:=FILE.yaml starts it. "
      "doc/meshes.md explains all of this.";
  return help;
}

}  // namespace organ_collision
