#pragma once

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <string>

namespace organ_collision {

/// Calls a service over a new connection. Returns false if the service failed or did not answer.
///
/// The service must be advertised already. roscpp asks the master for it once: if the master does
/// not know it yet, the client is invalid, and its call returns false at once.
///
/// The connection is persistent, which means that the client closes it. Otherwise the server closes
/// it as soon as it has sent its answer. If roscpp's polling thread sees that before the thread of
/// the call waits for the answer, roscpp drops the answer, and the call returns false. On a busy
/// machine this happens to one call in some thousands, also between two programs that do nothing
/// else.
///
/// If the server closed the connection nevertheless, the call is made once more. roscpp's polling
/// thread in the server may hold the event that an earlier client hung up, while the thread of a
/// callback closes the connection to that client. A new connection then gets the same file
/// descriptor, and roscpp takes the event for one of the new connection, and closes it. Then the
/// client is invalid. A service that fails leaves its connection open, and is not called again.
template <typename Service>
bool call_service(const std::string& name, Service& service) {
  for (int connection = 0; connection < 2; ++connection) {
    ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(name, /*persistent=*/true);
    if (client.call(service)) return true;
    if (client.isValid()) return false;
  }
  return false;
}

}  // namespace organ_collision
