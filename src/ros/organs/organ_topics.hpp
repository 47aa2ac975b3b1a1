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
#include "sequence_gaps.hpp"

namespace organ_collision {

/// A message about an organ, and what it did.
struct OrganUpdate {
  OrganMessage message;
  std::optional<OrganChange> change = {};  ///< empty: the message was refused, and changed nothing
  /// Why the organ has no new shape: a status of ContactArray, and its message. OK if it has one.
  std::uint8_t status = 0;
  std::string why_not = {};
};

/// What became of the messages since the start:
/// received = applied + removals + refused + dropped + waiting.
struct OrganMessageCounts {
  std::uint64_t received = 0;  ///< with the removals by remove()
  std::uint64_t applied = 0;   ///< an organ has a new shape
  std::uint64_t removals = 0;  ///< of organs, also of unknown ones
  std::uint64_t refused = 0;
  std::uint64_t dropped = 0;  ///< replaced by later ones, behind a large mesh
  std::uint64_t waiting = 0;  ///< now, for their turn or for a large mesh
  /// Not received, because a queue on the way was full: gaps in the numbers of the messages.
  std::uint64_t lost = 0;
};

/// Meshes and vertices of organs as they come on the node's topics, applied to the known organs in
/// the order in which they came.
class OrganTopics {
 public:
  /// All must outlive this. `callbacks`: the queue of the thread that calls next(). A callback is
  /// added to it to wake that thread.
  OrganTopics(OrganRegistry& organs, FailureLog& rejected, ros::CallbackQueueInterface& callbacks);

  void subscribe(const ros::NodeHandle& private_node);

  /// Take a message of a topic. `connection`: the one over which the mesh came.
  void take_mesh(const OrganMeshConstPtr& message, const Connection& connection = {});
  void take_vertices(const OrganVerticesConstPtr& message);
  /// Removes an organ, as a mesh without vertices and triangles does: after the messages that were
  /// taken before. Throws Rejection if there is no such organ.
  void remove(const std::string& organ);
  /// Applies the next message that can be applied now. Returns std::nullopt if there is none. A
  /// message that is refused is counted as rejected, except for vertices that come in the first 2 s
  /// before the mesh of their organ: then a simulator is only starting.
  std::optional<OrganUpdate> next();

  OrganMessageCounts counts() const;

 private:
  OrganChange apply(OrganMessage& message);
  void count(const Rejection& rejection);

  OrganRegistry& organs_;
  FailureLog& rejected_;
  OrganMessageQueue queue_;
  OrganMessageCounts counts_;  ///< without what the queue counts
  SequenceGaps mesh_gaps_, vertices_gaps_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace organ_collision
