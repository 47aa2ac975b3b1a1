#include "parameter_updates.hpp"

#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <exception>
#include <mutex>

namespace ros::param {

/// roscpp's own answer to `paramUpdate`. The library exports it, but no header declares it.
// NOLINTNEXTLINE(readability-identifier-naming)
void paramUpdateCallback(XmlRpc::XmlRpcValue& params, XmlRpc::XmlRpcValue& result);

}  // namespace ros::param

namespace organ_collision {
namespace {

constexpr char kMethod[] = "paramUpdate";

void update(XmlRpc::XmlRpcValue& params, XmlRpc::XmlRpcValue& result) {
  try {
    ros::param::paramUpdateCallback(params, result);
  } catch (const std::exception& error) {
    throw XmlRpc::XmlRpcException(error.what());
  }
}

}  // namespace

void guard_parameter_updates() {
  static std::once_flag is_guarded;
  std::call_once(is_guarded, [] {
    const ros::XMLRPCManagerPtr& manager = ros::XMLRPCManager::instance();
    manager->unbind(kMethod);
    manager->bind(kMethod, update);
  });
}

}  // namespace organ_collision
