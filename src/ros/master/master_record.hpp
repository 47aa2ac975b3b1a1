#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

namespace organ_collision {

using Names = std::set<std::string>;

/// What the ROS master knows: the nodes behind each topic and service.
struct MasterRecord {
  std::map<std::string, Names> publishers, subscribers, providers;

  static bool lists(const std::map<std::string, Names>& nodes, const std::string& topic,
                    const std::string& node) {
    const auto found = nodes.find(topic);
    return found != nodes.end() && found->second.count(node) > 0;
  }
};

/// The types of the topics that this process publishes or subscribes to.
using Types = std::map<std::string, std::string>;

/// Publishers from which this process receives, as "host:port" of their XML-RPC servers, by topic.
using Links = std::map<std::string, Names>;

/// Nothing if the master does not answer.
std::optional<MasterRecord> read_master();
/// Both ask this process' own XML-RPC server; empty if it shuts down.
Types read_types();
Links read_links();

/// "host:port" of a URI; empty if it has none.
std::string address(const std::string& uri);

}  // namespace organ_collision
