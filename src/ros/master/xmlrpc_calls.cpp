#include "xmlrpc_calls.hpp"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcClient.h>

namespace organ_collision {

using XmlRpc::XmlRpcValue;

XmlRpcValue caller_and() {
  XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  return arguments;
}

std::optional<XmlRpcValue> call_master(const std::string& method, const XmlRpcValue& arguments) {
  XmlRpcValue response, payload;
  if (ros::isShuttingDown()) return std::nullopt;
  if (!ros::master::execute(method, arguments, response, payload, false)) return std::nullopt;
  return payload;
}

std::optional<XmlRpcValue> call_self(const std::string& method, const XmlRpcValue& arguments) {
  if (ros::isShuttingDown())
    return std::nullopt;  // The server may have stopped: it would not answer.
  const ros::XMLRPCManagerPtr& manager = ros::XMLRPCManager::instance();
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(manager->getServerURI(), host, port)) return std::nullopt;
  XmlRpc::XmlRpcClient* const client = manager->getXMLRPCClient(host, static_cast<int>(port), "/");
  XmlRpcValue response, payload;
  const bool is_answered = client->execute(method.c_str(), arguments, response) &&
                           manager->validateXmlrpcResponse(method, response, payload);
  manager->releaseXMLRPCClient(client);
  if (!is_answered) return std::nullopt;
  return payload;
}

}  // namespace organ_collision
