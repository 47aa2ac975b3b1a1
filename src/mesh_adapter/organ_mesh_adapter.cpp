#include "organ_mesh_adapter.hpp"

#include <algorithm>
#include <chrono>
#include <random>

#include "message_error.hpp"
#include "organ_collision/ros/names.hpp"
#include "ros/interface/plain_text.hpp"

namespace organ_collision {
namespace {

/// [messages] Meshes are rare, but another marker must not displace the organ's marker in the
/// queue.
constexpr std::uint32_t kSurfaceQueue = 10;
/// [messages] Only the newest vertices count.
constexpr std::uint32_t kVerticesQueue = 1;

/// [messages] A new subscriber is sent a mesh of each organ at once.
std::uint32_t outgoing_queue(const MeshAdapterParameters& parameters) {
  return std::max<std::uint32_t>(100, 2 * parameters.organs.size());
}

}  // namespace

OrganMeshAdapter::OrganMeshAdapter(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(node), parameters_(load_mesh_adapter_parameters(private_node)) {
  for (const std::string& sentence : parameters_.misspelt) ROS_WARN("%s", sentence.c_str());

  // Not latched: a latched topic keeps only the last message. A new subscriber would get only one
  // organ, and in an old shape.
  ros::NodeHandle collision_node(node_, parameters_.collision_node);
  meshes_ = collision_node.advertise<OrganMesh>(
      names::kOrganMesh, outgoing_queue(parameters_),
      [this](const ros::SingleSubscriberPublisher& newcomer) { welcome(newcomer); });
  vertices_ =
      collision_node.advertise<OrganVertices>(names::kOrganVertices, outgoing_queue(parameters_));
  // Random, because the collision node may still have meshes of an earlier adapter.
  const std::uint32_t last_topology = std::random_device()();
  for (const OrganParameters& organ : parameters_.organs) add_source(organ, last_topology);
  ROS_INFO("ready: %s, for %s", counted(sources_.size(), "organ").c_str(),
           collision_node.getNamespace().c_str());
}

void OrganMeshAdapter::add_source(const OrganParameters& organ, std::uint32_t last_topology) {
  OrganSource& source = sources_.emplace_back(
      organ, last_topology,
      OrganFeed::Outlet{[this](const OrganMeshPtr& message) { meshes_.publish(message); },
                        [this](const OrganVerticesPtr& message) { vertices_.publish(message); }});
  subscribe(organ.topic, kSurfaceQueue, [&source](const Message& message, ros::Time arrival) {
    source.take_surface(message, arrival);
  });
  if (organ.vertices_topic.empty()) return;
  subscribe(organ.vertices_topic, kVerticesQueue,
            [&source](const Message& message, ros::Time arrival) {
              source.take_vertices(message, arrival);
            });
}

void OrganMeshAdapter::subscribe(const std::string& topic, std::uint32_t queue_size,
                                 const std::function<void(const Message&, ros::Time)>& take) {
  const std::string name = node_.resolveName(topic);
  const boost::function<void(const Event&)> callback = [this, name, take](const Event& event) {
    try {
      take(*event.getConstMessage(), event.getReceiptTime());
    } catch (const MessageError& error) {
      const std::string from = name + ": ";
      refused_.add(from + error.reason(), from + error.what(), std::chrono::steady_clock::now());
    }
  };
  subscribers_.push_back(node_.subscribe<Message>(topic, queue_size, callback, {},
                                                  ros::TransportHints().tcpNoDelay()));
}

/// Sends a new subscriber all organs in their latest shape.
void OrganMeshAdapter::welcome(const ros::SingleSubscriberPublisher& newcomer) const {
  for (const OrganSource& source : sources_) {
    if (const OrganMeshPtr mesh = source.mesh()) newcomer.publish(mesh);
  }
}

}  // namespace organ_collision
