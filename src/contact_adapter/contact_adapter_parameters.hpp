#pragma once

#include <string>
#include <vector>

#include "forces/forces.hpp"
#include "ros/node/program.hpp"
#include "ros/parameters/parameter_table.hpp"

/// The names of contact_adapter in the ROS graph, besides those of the collision node and of all
/// nodes with forces.
namespace organ_collision::names {

inline constexpr char kContactAdapter[] = "contact_adapter";
/// A topic of a pair, below ~ORGAN/TOOL.
inline constexpr char kFaces[] = "faces";

}  // namespace organ_collision::names

namespace organ_collision {

/// The parameters of contact_adapter, with the documented defaults.
struct ContactAdapterParameters {
  double stiffness = 300.0;            ///< [N/m] of the penalty law
  double max_force = kUnlimited;       ///< [N] larger forces are scaled down to it
  bool way_out = true;                 ///< a tool wholly inside is pushed along the nearest way out
  double diagnostic_period_sec = 1.0;  ///< in wall time
  std::vector<std::string> misspelt{};  ///< a sentence for each unknown name
};

ParameterTable table_of(ContactAdapterParameters& parameters);

/// What --help says. doc/forces.md explains the same names at length; a test compares both.
ProgramHelp contact_adapter_help();

}  // namespace organ_collision
