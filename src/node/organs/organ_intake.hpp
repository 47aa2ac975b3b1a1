#pragma once

#include <organ_collision/ListOrgans.h>
#include <organ_collision/RemoveOrgan.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/messages/failure_log.hpp"
#include "organ_registry.hpp"

namespace organ_collision {

/// A message about one organ: either `mesh` or `vertices` is set, and the other one is null.
struct OrganMessage {
  OrganMeshConstPtr mesh = {};
  Connection connection = {};            ///< over which the message came
  std::future<TriangleMesh> built = {};  ///< valid only if another thread builds the mesh
  OrganVerticesConstPtr vertices = {};

  const std::string& organ() const { return mesh ? mesh->organ : vertices->organ; }
  const std_msgs::Header& header() const { return mesh ? mesh->header : vertices->header; }
};

/// A message about an organ, and what it did.
struct OrganUpdate {
  OrganMessage message;
  std::optional<OrganChange> change = {};  ///< empty: the message was refused, and changed nothing
  /// The status of ContactArray, and why the organ has no new shape. OK and empty if it has one.
  std::uint8_t status = 0;
  std::string why_not = {};
};

/// What became of the messages since the start. received = applied + removals + refused + dropped +
/// waiting.
struct OrganMessageCounts {
  std::uint64_t received = 0;  ///< all messages, and the removals by the service
  std::uint64_t applied = 0;   ///< messages that gave an organ a new shape
  std::uint64_t removals = 0;  ///< messages that removed an organ, also an unknown one
  std::uint64_t refused = 0;
  std::uint64_t dropped = 0;  ///< messages that waited until a later one replaced them
  std::uint64_t waiting = 0;  ///< messages that wait now for their turn or for a large mesh
  /// Messages that did not arrive, because a queue was full: gaps in the sequence numbers.
  std::uint64_t lost = 0;
};

/// Receives meshes and vertices of organs, and applies them to the known organs. Serves
/// `list_organs` and `remove_organ`.
///
/// A large mesh with new triangles is first built in another thread, whose priority is lower than
/// that of the steps. Meanwhile, later messages of the same organ wait, so that the messages of
/// each organ keep their order. Messages of other organs do not wait. A waiting message is dropped
/// if a later one makes it superfluous. What takes even longer than building, such as finding out
/// whether a surface is closed, is done in a third thread after the mesh has been applied.
class OrganIntake {
 public:
  /// [faces or vertices] Meshes up to this size are built when they are applied, in a millisecond
  /// or less.
  static constexpr std::size_t kLarge = 10'000;

  /// The queues of the threads that work for the intake.
  struct Threads {
    ros::CallbackQueue& node;       ///< calls next(); woken when a mesh has been built
    ros::CallbackQueue& builder;    ///< builds large meshes
    ros::CallbackQueue& inspector;  ///< finds out surfaces, logs what came, and lists organs
  };

  /// All arguments must outlive this object. When it is destroyed, `builder` and `inspector` must
  /// no longer call callbacks. Without threads, next() does all work itself, so that its results do
  /// not depend on when another thread is done.
  OrganIntake(OrganRegistry& organs, FailureLog& rejected, std::optional<Threads> threads = {})
      : organs_(organs), rejected_(rejected), threads_(threads) {}
  OrganIntake(const OrganIntake&) = delete;  ///< The subscriptions refer to this.

  /// Subscribes to the topics and advertises the services. The constructor must have got threads.
  void subscribe(ros::NodeHandle private_node);

  /// Takes a message of a topic. `connection`: over which it came.
  void take_mesh(const OrganMeshConstPtr& message, const Connection& connection = {});
  void take_vertices(const OrganVerticesConstPtr& message, const Connection& connection = {});

  /// Applies the next message that need not wait for a mesh. Returns std::nullopt if there is none.
  /// A refused message is added to the rejected ones, except for vertices without a mesh in the
  /// first 2 s: then a simulator is only starting.
  std::optional<OrganUpdate> next();

  OrganMessageCounts counts() const;

  /// Serves list_organs in the inspector's thread, because volumes of large organs take
  /// milliseconds. Returns false if the node ends before its thread gives the shapes.
  bool on_list(ListOrgans::Request& request, ListOrgans::Response& response);
  /// Serves remove_organ in the node's thread. Removes an organ after the messages that were taken
  /// before, as a mesh without vertices and triangles does.
  bool on_remove(RemoveOrgan::Request& request, RemoveOrgan::Response& response);

 private:
  void add(OrganMessage message);
  void begin(OrganMessage& message);
  OrganUpdate apply(OrganMessage waiting);
  void inspect(const DeformableOrgan& organ);

  OrganRegistry& organs_;
  FailureLog& rejected_;
  std::optional<Threads> threads_;
  /// The waiting messages of each organ, the oldest first. Another thread may be building the mesh
  /// of the oldest one. No list is empty.
  std::map<std::string, std::deque<OrganMessage>> messages_;
  OrganMessageCounts counts_;  ///< without `waiting`, which counts() adds
  /// The sequence numbers of the last messages, by publisher.
  std::map<std::string, std::uint32_t> meshes_, vertices_;
  SurfaceLog log_;  ///< used only in the inspector's thread
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> services_;
};

/// How many messages of a publisher were lost between its last message and the present one, which
/// has the sequence number `number`. If the number does not rise, the publisher has started again.
/// `last`: the numbers of the last messages by publisher. Sets the publisher's entry to `number`.
std::uint64_t lost_before(std::map<std::string, std::uint32_t>& last, const std::string& publisher,
                          std::uint32_t number);

}  // namespace organ_collision
