#include "organ_topics.hpp"

#include <organ_collision/ContactArray.h>
#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/function_callback.hpp"

namespace organ_collision {
namespace {

/// [messages] For all organs together. If more wait while the node's thread is busy, roscpp drops
/// the oldest.
constexpr std::uint32_t kQueue = 100;

/// Vertices may come this long before the mesh of their organ.
constexpr std::chrono::seconds kStart(2);

}  // namespace

OrganTopics::OrganTopics(OrganRegistry& organs, FailureLog& rejected,
                         ros::CallbackQueueInterface& callbacks)
    : organs_(organs),
      rejected_(rejected),
      queue_({[this](const OrganMeshConstPtr& message) { return organs_.build(message); },
              [this](const OrganMesh& message, const Connection& connection) {
                return organs_.is_new(message, connection);
              },
              [&callbacks] { call_later(callbacks, [] {}); }}) {}

void OrganTopics::subscribe(ros::NodeHandle private_node) {
  using MeshEvent = ros::MessageEvent<const OrganMesh>;
  const boost::function<void(const MeshEvent&)> add_mesh = [this](const MeshEvent& event) {
    take_mesh(event.getConstMessage(), event.getConnectionHeaderPtr());
  };
  const auto no_delay = ros::TransportHints().tcpNoDelay();
  subscribers_ = {
      private_node.subscribe<OrganMesh>(names::kOrganMesh, kQueue, add_mesh, {}, no_delay),
      private_node.subscribe<OrganVertices>(
          names::kOrganVertices, kQueue,
          [this](const OrganVerticesConstPtr& message) { take_vertices(message); }, {}, no_delay)};
}

void OrganTopics::remove(const std::string& organ) {
  check_name("organ", organ);
  if (!queue_.has(organ)) organs_.at(organ);
  const auto removal = boost::make_shared<OrganMesh>();
  removal->organ = organ;
  take_mesh(removal);
}

std::optional<OrganUpdate> OrganTopics::next() {
  std::optional<OrganMessage> message = queue_.next();
  if (!message) return std::nullopt;
  OrganUpdate update{*std::move(message)};
  try {
    update.change = apply(update.message);
    if (update.change == OrganChange::kRemoved) {
      update.status = ContactArray::NO_MESH;
      update.why_not = "organ '" + update.message.organ() + "' was removed";
    }
  } catch (const Rejection& rejection) {
    count(rejection);
    update.status = rejection.status();
    update.why_not = rejection.what();
  }
  return update;
}

void OrganTopics::count(const Rejection& rejection) {
  const auto now = std::chrono::steady_clock::now();
  if (rejection.status() == ContactArray::UNKNOWN_ORGAN && now - start_ < kStart) {
    ROS_DEBUG("%s", rejection.what());
  } else {
    rejected_.add(rejection.reason(), rejection.what(), now);
  }
}

OrganChange OrganTopics::apply(OrganMessage& message) {
  const ros::Time now = ros::Time::now();
  if (message.vertices) return organs_.apply(message.vertices, now);
  return organs_.apply(message.mesh, message.connection, now, [&] {
    return message.built.valid() ? message.built.get() : organs_.build(message.mesh);
  });
}

}  // namespace organ_collision
