#pragma once

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <string>

namespace organ_collision {

/// Calls a service over a new connection. Returns false if no answer came.
///
/// The connection is persistent, which means that the client closes it. Otherwise the server closes
/// it as soon as it has sent its answer. If roscpp's polling thread sees that before the thread of
/// the call waits for the answer, roscpp drops the answer, and the call returns false. On a busy
/// machine this happens to one call in some thousands, also between two programs that do nothing
/// else. On a machine without an idle processor, a call over a persistent connection was lost, too.
/// Therefore a call is repeated twice: a node that does not answer fails all three times.
template <typename Service>
bool call_service(const std::string& name, Service& service) {
  ros::NodeHandle node;
  for (int attempt = 0; attempt < 3; ++attempt) {
    if (node.serviceClient<Service>(name, /*persistent=*/true).call(service)) return true;
  }
  return false;
}

}  // namespace organ_collision
