#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

#include "ros/interface/parameter_group.hpp"

namespace organ_collision {

/// Where one organ's surface comes from.
struct OrganParameters {
  std::string name;
  std::string topic;
  std::string frame;           ///< empty: the messages' own
  std::string vertices_topic;  ///< empty: none
};

/// The adapter's parameters, as validated.
struct MeshAdapterParameters {
  std::vector<OrganParameters> organs;
  std::string collision_node = "organ_collision";
  std::vector<std::string> misspelt;  ///< one sentence for each name that the adapter does not know
};

/// Reads the members of the node's private namespace. Throws ParameterError.
MeshAdapterParameters parse_mesh_adapter_parameters(const XmlRpc::XmlRpcValue& private_namespace);

/// The same from the parameter server.
MeshAdapterParameters load_mesh_adapter_parameters(const ros::NodeHandle& private_node);

}  // namespace organ_collision
