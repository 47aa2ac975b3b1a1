#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "organ_message_queue.hpp"
#include "organ_registry.hpp"
#include "ros/interface/failure_log.hpp"

namespace organ_collision {

/// A message about an organ, and what it did.
struct OrganUpdate {
  OrganMessage message;
  std::optional<OrganChange> change = {};  ///< empty: the message was refused, and changed nothing
  /// Why the organ has no new shape: a status of ContactArray, and its message. OK if it has one.
  std::uint8_t status = 0;
  std::string why_not = {};
};

/// Meshes and vertices of organs as they come on the node's topics, applied to the known organs in
/// the order in which they came.
class OrganTopics {
 public:
  /// All must outlive this. `callbacks`: the queue of the thread that calls next(). A callback is
  /// added to it to wake that thread.
  OrganTopics(OrganRegistry& organs, FailureLog& rejected, ros::CallbackQueueInterface& callbacks);

  void subscribe(ros::NodeHandle private_node);

  /// Take a message of a topic. `connection`: the one over which the mesh came.
  void take_mesh(const OrganMeshConstPtr& message, const Connection& connection = {}) {
    queue_.add(message, connection);
  }
  void take_vertices(const OrganVerticesConstPtr& message) { queue_.add(message); }
  /// Removes an organ, as a mesh without vertices and triangles does: after the messages that were
  /// taken before. Throws Rejection if there is no such organ.
  void remove(const std::string& organ);
  /// Applies the next message that can be applied now. Returns std::nullopt if there is none. A
  /// message that is refused is counted as rejected, except for vertices that come in the first 2 s
  /// before the mesh of their organ: then a simulator is only starting.
  std::optional<OrganUpdate> next();

 private:
  OrganChange apply(OrganMessage& message);
  void count(const Rejection& rejection);

  OrganRegistry& organs_;
  FailureLog& rejected_;
  OrganMessageQueue queue_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace organ_collision
