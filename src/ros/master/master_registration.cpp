#include "master_registration.hpp"

#include <ros/connection_manager.h>
#include <ros/init.h>
#include <ros/network.h>
#include <ros/param.h>
#include <ros/service_manager.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "xmlrpc_calls.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

std::string own_uri() { return ros::XMLRPCManager::instance()->getServerURI(); }

std::string own_service_uri() {
  return "rosrpc://" + ros::network::getHost() + ":" +
         std::to_string(ros::ConnectionManager::instance()->getTCPPort());
}

bool is_served(const std::string& service) {
  return ros::ServiceManager::instance()->lookupServicePublication(service) != nullptr;
}

/// Whether the master knows a node of this name at another address.
bool is_replaced(const std::string& name, const std::string& uri) {
  const std::optional<XmlRpcValue> known = call_master("lookupNode", caller_and(name));
  return known && known->getType() == XmlRpcValue::TypeString &&
         static_cast<std::string>(XmlRpcValue(*known)) != uri;
}

void register_publisher(const std::string& topic, const std::string& type) {
  call_master("registerPublisher", caller_and(topic, type, own_uri()));
}

void register_service(const std::string& service) {
  call_master("registerService", caller_and(service, own_service_uri(), own_uri()));
}

/// Registers the subscription, and lets roscpp connect to the publishers that the master names.
/// Those that are connected must be among them: roscpp closes the others.
void register_subscriber(const std::string& topic, const std::string& type, const Links& links) {
  std::optional<XmlRpcValue> uris =
      call_master("registerSubscriber", caller_and(topic, type, own_uri()));
  if (!uris || uris->getType() != XmlRpcValue::TypeArray) return;
  if (const auto connected = links.find(topic); connected != links.end()) {
    for (const std::string& publisher : connected->second) {
      (*uris)[uris->size()] = "http://" + publisher + "/";
    }
  }
  call_self("publisherUpdate", caller_and(topic, *uris));
}

Names common(const Names& a, const Names& b) {
  Names both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
  return both;
}

/// Those of `topics` behind which the master does not know this node.
Names not_listed(const ros::V_string& topics, const std::map<std::string, Names>& nodes) {
  Names missing;
  for (const std::string& topic : topics) {
    if (!MasterRecord::lists(nodes, topic, ros::this_node::getName())) missing.insert(topic);
  }
  return missing;
}

}  // namespace

MasterRegistration::Outcome MasterRegistration::check() {
  const auto master = read_master();
  if (!master || ros::isShuttingDown()) return Outcome::kNoAnswer;
  const Missing now = find_missing(*master);
  const Missing before = std::exchange(missing_, now);
  if (now.empty()) remember(*master);
  const Missing lasting{common(now.published, before.published),
                        common(now.subscribed, before.subscribed),
                        common(now.services, before.services)};
  if (lasting.empty() || is_replaced(ros::this_node::getName(), own_uri())) {
    return Outcome::kNothingToDo;
  }
  restore(lasting, *master);
  return Outcome::kRegisteredAgain;
}

MasterRegistration::Missing MasterRegistration::find_missing(const MasterRecord& master) const {
  ros::V_string published, subscribed, served;
  ros::this_node::getAdvertisedTopics(published);
  ros::this_node::getSubscribedTopics(subscribed);
  std::copy_if(services_.begin(), services_.end(), std::back_inserter(served), is_served);
  return {not_listed(published, master.publishers), not_listed(subscribed, master.subscribers),
          not_listed(served, master.providers)};
}

/// roscpp does not tell the names of its services. So those are remembered that the master lists.
void MasterRegistration::remember(const MasterRecord& master) {
  const std::string& self = ros::this_node::getName();
  for (const auto& [service, nodes] : master.providers) {
    if (nodes.count(self) > 0) services_.insert(service);
  }
  for (const auto& [topic, publishers] : read_links()) {
    const bool are_known =
        std::all_of(publishers.begin(), publishers.end(),
                    [this](const std::string& known) { return publishers_.count(known) > 0; });
    if (!are_known) remember_publishers(topic, master);
  }
  ros::param::get(parameters_, last_parameters_);
}

void MasterRegistration::remember_publishers(const std::string& topic, const MasterRecord& master) {
  const auto publishers = master.publishers.find(topic);
  if (publishers == master.publishers.end()) return;
  for (const std::string& name : publishers->second) {
    const auto uri = call_master("lookupNode", caller_and(name));
    if (!uri || uri->getType() != XmlRpcValue::TypeString) continue;
    const auto text = static_cast<std::string>(XmlRpcValue(*uri));
    publishers_[address(text)] = {name, text};
  }
}

void MasterRegistration::restore(const Missing& missing, const MasterRecord& master) {
  const Links links = read_links();
  const Types types = read_types();
  restore_parameters();
  for (const auto& [topic, type] : types) {
    if (missing.published.count(topic) > 0) register_publisher(topic, type);
    if (missing.subscribed.count(topic) == 0) continue;
    introduce_publishers(topic, type, links, master);
    register_subscriber(topic, type, links);
  }
  for (const std::string& service : missing.services) register_service(service);
}

/// If the master's parameters are new, too, this process gets back those that it had.
void MasterRegistration::restore_parameters() const {
  if (last_parameters_.valid() && !ros::param::has(parameters_)) {
    ros::param::set(parameters_, last_parameters_);
  }
}

/// Registers the publishers from which this process still receives, in their names. Otherwise, the
/// next publisher of this topic would make the master send a list without them, and roscpp would
/// close their connections.
void MasterRegistration::introduce_publishers(const std::string& topic, const std::string& type,
                                              const Links& links,
                                              const MasterRecord& master) const {
  const auto connected = links.find(topic);
  if (connected == links.end()) return;
  for (const std::string& link : connected->second) {
    const auto publisher = publishers_.find(link);
    if (publisher == publishers_.end() || link == address(own_uri())) continue;
    const auto& [name, uri] = publisher->second;
    if (MasterRecord::lists(master.publishers, topic, name) || is_replaced(name, uri)) continue;
    XmlRpcValue arguments;
    arguments[0] = name;
    arguments[1] = topic;
    arguments[2] = type;
    arguments[3] = uri;
    call_master("registerPublisher", arguments);
  }
}

}  // namespace organ_collision
