#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <limits>
#include <string>
#include <vector>

#include "forces/forces.hpp"
#include "ros/parameters/live_parameters.hpp"
#include "ros/parameters/program_help.hpp"

/// All names of contact_adapter in the ROS graph, besides those of the collision node and of all
/// nodes with forces.

namespace organ_collision::names {

inline constexpr char kContactAdapter[] = "contact_adapter";

/// A topic of a pair, below ~ORGAN/TOOL.
inline constexpr char kFaces[] = "faces";

inline constexpr char kWayOut[] = "way_out";

}  // namespace organ_collision::names

namespace organ_collision {

/// The parameters that can be changed while the node runs, with the documented defaults.
struct LiveContactAdapterParameters {
  double stiffness = 300.0;  ///< [N/m] of the penalty law
  double max_force =
      std::numeric_limits<double>::infinity();  ///< [N] larger forces are scaled down to it
};

/// The validated parameters of the node, with the documented defaults.
struct ContactAdapterParameters : LiveContactAdapterParameters {
  bool way_out = true;                 ///< a tool wholly inside is pushed along the nearest way out
  double diagnostic_period_sec = 1.0;  ///< in wall time
  std::vector<std::string> misspelt{};  ///< a sentence for each unknown name
};

/// Reads the parameters from the members of the adapter's private namespace. Throws ParameterError.
ContactAdapterParameters parse_contact_adapter_parameters(const XmlRpc::XmlRpcValue& all);

/// Reads the parameters from the parameter server. Throws ParameterError.
ContactAdapterParameters load_contact_adapter_parameters(const ros::NodeHandle& private_node);

/// The members of LiveContactAdapterParameters, for LiveParameters.
std::vector<LiveParameter> live_parameters(const LiveContactAdapterParameters& parameters);

/// The parameters after these changes. Throws ParameterError if a change is illegal, or if the
/// parameter cannot be changed while the node runs.
LiveContactAdapterParameters changed(const LiveContactAdapterParameters& parameters,
                                     const XmlRpc::XmlRpcValue& changes);

/// What --help of contact_adapter says. doc/forces.md explains the same names at length; a test
/// compares both.
ProgramHelp contact_adapter_help();

}  // namespace organ_collision
