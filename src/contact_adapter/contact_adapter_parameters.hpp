#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <limits>
#include <string>
#include <vector>

namespace organ_collision {

/// As validated; the defaults are the documented ones.
struct ContactAdapterParameters {
  double stiffness = 300.0;                                    ///< [N/m] of the penalty law
  double max_force = std::numeric_limits<double>::infinity();  ///< [N] larger ones are clipped
  double diagnostic_period_sec = 1.0;                          ///< of wall time
  std::vector<std::string> misspelt{};  ///< a sentence for each name that the adapter does not know
};

/// Reads the members of the adapter's private namespace. Throws ParameterError.
ContactAdapterParameters parse_contact_adapter_parameters(const XmlRpc::XmlRpcValue& all);

/// The same from the parameter server.
ContactAdapterParameters load_contact_adapter_parameters(const ros::NodeHandle& private_node);

}  // namespace organ_collision
