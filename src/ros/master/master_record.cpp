#include "master_record.hpp"

#include <ros/network.h>

#include "xmlrpc_calls.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

/// Of [[name, [node, ...]], ...].
std::map<std::string, Names> nodes_by_name(XmlRpcValue& list) {
  std::map<std::string, Names> nodes;
  for (int i = 0; i < list.size(); ++i) {
    Names& of_name = nodes[static_cast<std::string>(list[i][0])];
    for (int j = 0; j < list[i][1].size(); ++j) {
      of_name.insert(static_cast<std::string>(list[i][1][j]));
    }
  }
  return nodes;
}

}  // namespace

std::optional<MasterRecord> read_master() {
  std::optional<XmlRpcValue> state = call_master("getSystemState", caller_and());
  if (!state) return std::nullopt;
  return MasterRecord{nodes_by_name((*state)[0]), nodes_by_name((*state)[1]),
                      nodes_by_name((*state)[2])};
}

Types read_types() {
  Types types;
  for (const char* const method : {"getPublications", "getSubscriptions"}) {
    std::optional<XmlRpcValue> list = call_self(method, caller_and());  // [[topic, type], ...]
    for (int i = 0; list && i < list->size(); ++i) {
      types[static_cast<std::string>((*list)[i][0])] = static_cast<std::string>((*list)[i][1]);
    }
  }
  return types;
}

Links read_links() {
  Links links;
  std::optional<XmlRpcValue> info = call_self("getBusInfo", caller_and());
  if (!info) return links;
  for (int i = 0; i < info->size(); ++i) {
    XmlRpcValue& connection = (*info)[i];  // id, other end, direction, transport, topic, ...
    if (static_cast<std::string>(connection[2]) != "i") continue;
    const std::string publisher = address(static_cast<std::string>(connection[1]));
    if (!publisher.empty()) links[static_cast<std::string>(connection[4])].insert(publisher);
  }
  return links;
}

std::string address(const std::string& uri) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return {};
  return host + ":" + std::to_string(port);
}

}  // namespace organ_collision
