#include "organ_topics.hpp"

#include <organ_collision/ContactArray.h>
#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/checked_messages.hpp"
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

void OrganTopics::subscribe(const ros::NodeHandle& private_node) {
  subscribers_ = {
      subscribe_checked<OrganMesh>(
          private_node, names::kOrganMesh, kQueue,
          [this](const auto& event) {
            const OrganMeshConstPtr& message = event.getConstMessage();
            counts_.lost += mesh_gaps_.add(event.getPublisherName(), message->header.seq);
            take_mesh(message, event.getConnectionHeaderPtr());
          },
          rejected_),
      subscribe_checked<OrganVertices>(
          private_node, names::kOrganVertices, kQueue,
          [this](const auto& event) {
            const OrganVerticesConstPtr& message = event.getConstMessage();
            counts_.lost += vertices_gaps_.add(event.getPublisherName(), message->header.seq);
            take_vertices(message);
          },
          rejected_)};
}

void OrganTopics::take_mesh(const OrganMeshConstPtr& message, const Connection& connection) {
  queue_.add(message, connection);
  ++counts_.received;
}

void OrganTopics::take_vertices(const OrganVerticesConstPtr& message) {
  queue_.add(message);
  ++counts_.received;
}

OrganMessageCounts OrganTopics::counts() const {
  OrganMessageCounts counts = counts_;
  counts.dropped = queue_.dropped();
  counts.waiting = queue_.waiting();
  return counts;
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
    if (update.change != OrganChange::kRemoved) {
      ++counts_.applied;
    } else {
      update.status = ContactArray::NO_MESH;
      update.why_not = "organ '" + update.message.organ() + "' was removed";
      ++counts_.removals;
    }
  } catch (const Rejection& rejection) {
    ++counts_.refused;
    count(rejection);
    update.status = rejection.status();
    update.why_not = rejection.what();
  } catch (...) {  // Usually std::bad_alloc. The node counts it as an exception.
    ++counts_.refused;
    throw;
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
