#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_registry.hpp"
#include "ros/messages/failure_log.hpp"

namespace organ_collision {

/// Finds out which messages of a topic were lost before they came, by the sequence numbers that
/// publishers write into headers. roscpp and rospy number the messages of a topic one after
/// another.
class SequenceGaps {
 public:
  /// Notes a message. Returns how many of the same publisher are missing between the last one and
  /// this. A number that is not above the last one is of a publisher that started again.
  std::uint64_t add(const std::string& publisher, std::uint32_t number);

 private:
  std::map<std::string, std::uint32_t> last_;
};

/// A message about one organ: either `mesh` or `vertices` is set, and the other one is null.
struct OrganMessage {
  OrganMeshConstPtr mesh = {};
  Connection connection = {};            ///< the connection over which the mesh came
  std::future<TriangleMesh> built = {};  ///< valid only if the queue's thread builds the mesh
  OrganVerticesConstPtr vertices = {};

  const std::string& organ() const { return mesh ? mesh->organ : vertices->organ; }
  const std_msgs::Header& header() const { return mesh ? mesh->header : vertices->header; }
};

/// Holds organ messages until they can be applied without delay. A large mesh with new triangles is
/// built in the queue's own thread first, which leaves scarce processors to the steps. Later
/// messages of that organ wait behind it, so that the messages of each organ keep their order;
/// messages of other organs do not wait. Of a mesh that waits, only its turn tells whether its
/// triangles are new: the meshes before it may bring the same ones.
class OrganMessageQueue {
 public:
  /// [faces, and vertices] Meshes up to this size are built when they are applied, in a millisecond
  /// or less.
  static constexpr std::size_t kLarge = 10'000;
  /// If more messages of one organ wait, with the mesh that is being built, the oldest that a later
  /// one replaces are dropped: vertices, and meshes with another mesh behind them. The others are
  /// applied at once when the mesh is built; with a million faces, each takes 0.6 ms.
  static constexpr std::size_t kMostWaiting = 10;

  /// The functions of others that the queue calls.
  struct Functions {
    /// Builds a mesh; throws MeshError. Called in the queue's thread.
    std::function<TriangleMesh(const OrganMeshConstPtr&)> build;
    /// Whether the message's triangles are new to the organ, so that a mesh has to be built. Asked
    /// when all earlier messages of the organ have been taken.
    std::function<bool(const OrganMesh&, const Connection&)> is_new;
    /// Wakes the thread that calls next(), because a build has ended. Called in the queue's
    /// thread; may throw std::bad_alloc.
    std::function<void()> wake;
  };
  explicit OrganMessageQueue(Functions functions);
  /// Waits for the mesh that is being built. Meshes that wait behind it are not built.
  ~OrganMessageQueue();
  OrganMessageQueue(const OrganMessageQueue&) = delete;
  OrganMessageQueue& operator=(const OrganMessageQueue&) = delete;

  void add(const OrganMeshConstPtr& message, const Connection& connection = {});
  void add(const OrganVerticesConstPtr& message);

  /// Whether a message of this organ has been added and not yet taken.
  bool has(const std::string& organ) const;

  /// How many messages wait to be taken, most of them for a mesh that is being built, and how many
  /// were dropped meanwhile.
  std::size_t waiting() const;
  std::uint64_t dropped() const { return dropped_; }

  /// The next message that waits for no mesh, or std::nullopt if there is none now. Must be called
  /// from time to time even without a call of `wake`, which may fail.
  std::optional<OrganMessage> next();

 private:
  using Messages = std::deque<OrganMessage>;

  void add(OrganMessage message);
  void begin(OrganMessage& message);
  void drop_oldest(Messages& messages);
  std::future<TriangleMesh> start_building(const OrganMeshConstPtr& message);
  void build_meshes();
  void wake() const;

  Functions functions_;
  Messages ready_;
  std::map<std::string, Messages> waiting_;  ///< by organ: a mesh being built, and what came later
  std::uint64_t dropped_ = 0;

  std::mutex mutex_;  ///< guards the next two members
  std::deque<std::packaged_task<TriangleMesh()>> tasks_;
  bool stop_ = false;
  std::condition_variable has_work_;
  std::thread thread_;
};

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
