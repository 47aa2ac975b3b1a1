#pragma once

#include <string>
#include <vector>

#include "ros/parameters/parameter_table.hpp"

/// The keys of an entry of the parameter `organs` that error messages and --help name.
namespace organ_collision::names {

inline constexpr char kTopic[] = "topic";
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

/// The parameters of organ_mesh_adapter, with the documented defaults.
struct MeshAdapterParameters {
  std::vector<OrganParameters> organs;
  std::string collision_node = "organ_collision";
  double diagnostic_period_sec = 1.0;  ///< in wall time
  std::vector<std::string> misspelt;   ///< a sentence for each unknown name
};

ParameterTable table_of(MeshAdapterParameters& parameters);

}  // namespace organ_collision
