#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <optional>
#include <string>

namespace organ_collision {

// Calls of the ROS master and of this node's own XML-RPC server (its "slave API"). A call waits for
// the answer, so it belongs into a background thread. The first argument of each call is the name
// of the calling node. While ROS shuts down, nothing is called.

/// The arguments of a call: (this node's name, parts...).
XmlRpc::XmlRpcValue caller_and();
template <typename... Rest>
XmlRpc::XmlRpcValue caller_and(const Rest&... parts) {
  XmlRpc::XmlRpcValue arguments = caller_and();
  (..., (arguments[arguments.size()] = parts));
  return arguments;
}

/// What the master answers. Nothing if it cannot be reached, or refuses.
std::optional<XmlRpc::XmlRpcValue> call_master(const std::string& method,
                                               const XmlRpc::XmlRpcValue& arguments);
/// What this node's own server answers. Nothing if it does not.
std::optional<XmlRpc::XmlRpcValue> call_self(const std::string& method,
                                             const XmlRpc::XmlRpcValue& arguments);

}  // namespace organ_collision
