#include "organ_mesh_adapter.hpp"

#include <algorithm>
#include <chrono>
#include <random>

#include "organ_collision/ros/names.hpp"
#include "ros/messages/text.hpp"
#include "surface_messages.hpp"

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
    : node_(node),
      parameters_(load_mesh_adapter_parameters(private_node)),
      updater_(node, private_node, private_node.getNamespace()),
      master_(private_node.getNamespace()) {
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
  for (const OrganParameters& organ : parameters_.organs) add_organ(organ, last_topology);
  updater_.setHardwareID("none");
  updater_.add("meshes", this, &OrganMeshAdapter::diagnose);
  master_.add_to(updater_);
  // A timer of wall time, because the updater's own period stops when simulated time stops.
  diagnostic_timer_ =
      private_node.createWallTimer(ros::WallDuration(parameters_.diagnostic_period_sec),
                                   [this](const ros::WallTimerEvent&) { updater_.force_update(); });
  ROS_INFO("ready: %s, for %s", counted(organs_.size(), "organ").c_str(),
           collision_node.getNamespace().c_str());
}

void OrganMeshAdapter::add_organ(const OrganParameters& parameters, std::uint32_t last_topology) {
  const OrganFeed::Outlet outlet{
      [this](const OrganMeshPtr& message) {
        meshes_.publish(message);
        ++meshes_sent_;
      },
      [this](const OrganVerticesPtr& message) { vertices_.publish(message); }};
  Organ& organ = organs_.emplace_back(Organ{{parameters, last_topology, outlet}});
  subscribe(organ, parameters.topic, kSurfaceQueue, &OrganSource::take_surface);
  if (parameters.vertices_topic.empty()) return;
  subscribe(organ, parameters.vertices_topic, kVerticesQueue, &OrganSource::take_vertices);
}

void OrganMeshAdapter::subscribe(Organ& organ, const std::string& topic, std::uint32_t queue_size,
                                 Take take) {
  const std::string name = node_.resolveName(topic);
  const boost::function<void(const Event&)> callback = [this, name, take,
                                                        &organ](const Event& event) {
    ++organ.received;
    try {
      (organ.source.*take)(*event.getConstMessage(), event.getReceiptTime());
      ++organ.converted;
      organ.latest = std::chrono::steady_clock::now();
    } catch (const MessageError& error) {
      const std::string from = name + ": ";
      refused_.add(from + error.reason(), from + error.what(), std::chrono::steady_clock::now());
    }
  };
  subscribers_.push_back(node_.subscribe<Message>(topic, queue_size, callback, {},
                                                  ros::TransportHints().tcpNoDelay()));
}

void OrganMeshAdapter::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  status.summary(DiagnosticStatus::OK, "converting");
  status.add("organs", organs_.size());
  const auto now = std::chrono::steady_clock::now();
  for (const Organ& organ : organs_) {
    const OrganParameters& parameters = organ.source.parameters();
    status.add(parameters.name + ", messages received", organ.received);
    status.add(parameters.name + ", messages converted", organ.converted);
    if (organ.converted > 0) {
      status.add(parameters.name + ", age of last [s]",
                 std::chrono::duration<double>(now - organ.latest).count());
    }
    if (organ.received == 0) {
      status.mergeSummary(DiagnosticStatus::WARN, "organ '" + parameters.name +
                                                      "': nothing came yet on " +
                                                      node_.resolveName(parameters.topic));
    }
  }
  for (const std::string& sentence : parameters_.misspelt) {
    status.mergeSummary(DiagnosticStatus::WARN, sentence);
  }
  show_failures("refused", refused_, status);
}

/// Sends a new subscriber all organs in their latest shape. roscpp numbers only the messages to
/// all subscribers, from 0; these get the number of the last one, so that none seems to be lost.
void OrganMeshAdapter::welcome(const ros::SingleSubscriberPublisher& newcomer) const {
  for (const Organ& organ : organs_) {
    const OrganMeshPtr mesh = organ.source.mesh();
    if (!mesh) continue;
    mesh->header.seq = meshes_sent_ - 1;
    newcomer.publish(mesh);
  }
}

}  // namespace organ_collision
