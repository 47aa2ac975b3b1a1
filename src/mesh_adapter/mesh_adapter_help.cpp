#include "mesh_adapter_help.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <pcl_msgs/PolygonMesh.h>
#include <ros/names.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>
#include <visualization_msgs/Marker.h>

#include "mesh_adapter_names.hpp"
#include "mesh_adapter_parameters.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {

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
