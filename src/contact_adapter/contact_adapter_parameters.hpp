#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <limits>
#include <string>
#include <vector>

namespace organ_collision {

/// The validated parameters of the node, with the documented defaults.
struct ContactAdapterParameters {
  double stiffness = 300.0;  ///< [N/m] of the penalty law
  double max_force =
      std::numeric_limits<double>::infinity();  ///< [N] larger forces are scaled down to it
  double diagnostic_period_sec = 1.0;           ///< in wall time
  std::vector<std::string> misspelt{};          ///< a sentence for each unknown name
};

/// Reads the parameters from the members of the adapter's private namespace. Throws ParameterError.
ContactAdapterParameters parse_contact_adapter_parameters(const XmlRpc::XmlRpcValue& all);

/// Reads the parameters from the parameter server. Throws ParameterError.
ContactAdapterParameters load_contact_adapter_parameters(const ros::NodeHandle& private_node);

}  // namespace organ_collision
