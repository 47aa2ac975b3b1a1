#include "end_node.hpp"

#include <ros/master.h>
#include <ros/names.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <cstdint>

namespace organ_collision {

bool end_node(const std::string& name) {
  XmlRpc::XmlRpcValue request, response, address;
  request[0] = ros::this_node::getName();
  request[1] = ros::names::resolve(name);
  if (!ros::master::execute("lookupNode", request, response, address, false)) return false;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(address, host, port)) return false;
  XmlRpc::XmlRpcClient node(host.c_str(), static_cast<int>(port), "/");
  request[1] = "the demo is over";
  return node.execute("shutdown", request, response);
}

}  // namespace organ_collision
