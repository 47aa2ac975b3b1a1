#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

#include "ros/parameters/parameter_group.hpp"
#include "ros/parameters/program_help.hpp"

/// All names of organ_mesh_adapter in the ROS graph, besides those of the collision node.

namespace organ_collision::names {

inline constexpr char kMeshAdapter[] = "organ_mesh_adapter";

inline constexpr char kCollisionNode[] = "collision_node";
inline constexpr char kOrgans[] = "organs";

/// Members of each entry of `organs`.
inline constexpr char kOrganName[] = "name";
inline constexpr char kTopic[] = "topic";
inline constexpr char kFrame[] = "frame";
inline constexpr char kVerticesTopic[] = "vertices_topic";

}  // namespace organ_collision::names

namespace organ_collision {

/// Where one organ's surface comes from.
struct OrganParameters {
  std::string name;
  std::string topic;
  std::string frame;           ///< empty: the frame that the messages name
  std::string vertices_topic;  ///< empty: none
};

/// The validated parameters of the node, with the documented defaults.
struct MeshAdapterParameters {
  std::vector<OrganParameters> organs;
  std::string collision_node = "organ_collision";
  double diagnostic_period_sec = 1.0;  ///< in wall time
  std::vector<std::string> misspelt;   ///< a sentence for each unknown name
};

/// Reads the parameters from the members of the adapter's private namespace. Throws ParameterError.
MeshAdapterParameters parse_mesh_adapter_parameters(const XmlRpc::XmlRpcValue& private_namespace);

/// Reads the parameters from the parameter server. Throws ParameterError.
MeshAdapterParameters load_mesh_adapter_parameters(const ros::NodeHandle& private_node);

/// What --help of organ_mesh_adapter says. doc/meshes.md explains the same names at length; a test
/// compares both.
ProgramHelp mesh_adapter_help();

}  // namespace organ_collision
