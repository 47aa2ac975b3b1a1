#pragma once

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <string>

namespace organ_collision {

/// Calls a service once, over a new connection. Returns false if no answer came.
///
/// The service must be advertised already. roscpp asks the master for it once: if the master does
/// not know it yet, the client stays invalid, and the call returns false at once.
///
/// The connection is persistent, which means that the client closes it. Otherwise the server closes
/// it as soon as it has sent its answer. If roscpp's polling thread sees that before the thread of
/// the call waits for the answer, roscpp drops the answer, and the call returns false. On a busy
/// machine this happens to one call in some thousands, also between two programs that do nothing
/// else.
template <typename Service>
bool call_service(const std::string& name, Service& service) {
  return ros::NodeHandle().serviceClient<Service>(name, /*persistent=*/true).call(service);
}

}  // namespace organ_collision
