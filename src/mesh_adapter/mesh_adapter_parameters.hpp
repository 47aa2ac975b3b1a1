#pragma once

#include <string>
#include <vector>

#include "ros/node/program.hpp"
#include "ros/parameters/parameter_table.hpp"

/// The names of organ_mesh_adapter in the ROS graph, besides those of the collision node.
namespace organ_collision::names {

inline constexpr char kMeshAdapter[] = "organ_mesh_adapter";

///@{
/// A key of the entries of `organs`.
inline constexpr char kTopic[] = "topic";
inline constexpr char kVerticesTopic[] = "vertices_topic";
///@}

}  // namespace organ_collision::names

namespace organ_collision {

/// Where one organ's surface comes from.
struct OrganParameters {
  std::string name;
  std::string topic;
  std::string frame;           ///< empty: the frame that the messages name
  std::string vertices_topic;  ///< empty: none
};

/// The parameters of organ_mesh_adapter, with the documented defaults.
struct MeshAdapterParameters {
  std::vector<OrganParameters> organs;
  std::string collision_node = "organ_collision";
  double diagnostic_period_sec = 1.0;  ///< in wall time
  std::vector<std::string> misspelt;   ///< a sentence for each unknown name
};

ParameterTable table_of(MeshAdapterParameters& parameters);

/// What --help says. doc/meshes.md explains the same names at length; a test compares both.
ProgramHelp mesh_adapter_help();

}  // namespace organ_collision
