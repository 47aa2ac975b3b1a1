#pragma once

#include <ros/node_handle.h>
#include <ros/service_client.h>
#include <ros/time.h>

#include <string>

namespace organ_collision {

/// Calls a service over a new connection. Returns false if no answer came.
///
/// The connection is persistent, which means that the client closes it. Otherwise the server closes
/// it as soon as it has sent its answer. If roscpp's polling thread sees that before the thread of
/// the call waits for the answer, roscpp drops the answer, and the call returns false. On a busy
/// machine this happens to one call in some thousands, also between two programs that do nothing
/// else. On a machine without an idle processor, calls over persistent connections were lost, too.
/// Therefore a call is repeated for up to 10 s. A service that does not answer fails all that time.
template <typename Service>
bool call_service(const std::string& name, Service& service) {
  ros::NodeHandle node;
  const ros::WallTime give_up = ros::WallTime::now() + ros::WallDuration(10.0);
  while (!node.serviceClient<Service>(name, /*persistent=*/true).call(service)) {
    if (ros::WallTime::now() > give_up) return false;
    ros::WallDuration(0.05).sleep();
  }
  return true;
}

}  // namespace organ_collision
