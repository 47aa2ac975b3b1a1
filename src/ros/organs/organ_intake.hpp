#pragma once

#include <organ_collision/ListOrgans.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
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

#include "organ_registry.hpp"
#include "ros/messages/failure_log.hpp"

namespace organ_collision {

/// A message about one organ: either `mesh` or `vertices` is set, and the other one is null.
struct OrganMessage {
  OrganMeshConstPtr mesh = {};
  Connection connection = {};            ///< the connection over which the mesh came
  std::future<TriangleMesh> built = {};  ///< valid only if another thread builds the mesh
  OrganVerticesConstPtr vertices = {};

  const std::string& organ() const { return mesh ? mesh->organ : vertices->organ; }
  const std_msgs::Header& header() const { return mesh ? mesh->header : vertices->header; }
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

/// Receives meshes and vertices of organs, and applies them to the known organs. Serves
/// `list_organs` and `remove_organ`.
///
/// A large mesh with new triangles is built in another thread first, which leaves scarce processors
/// to the steps. Later messages of that organ wait behind it, so that the messages of each organ
/// keep their order; messages of other organs do not wait. Of those that wait, only the ones are
/// kept without which the organ would end in another state. What takes even longer, such as finding
/// out whether a surface is closed, is done in a third thread when the mesh is applied already.
class OrganIntake {
 public:
  /// [faces, and vertices] Meshes up to this size are built when they are applied, in a millisecond
  /// or less.
  static constexpr std::size_t kLarge = 10'000;

  /// The queues of the threads that work for the intake.
  struct Threads {
    ros::CallbackQueue& node;       ///< calls next(). It is woken when a mesh was built
    ros::CallbackQueue& builder;    ///< builds large meshes
    ros::CallbackQueue& inspector;  ///< finds out surfaces, logs what came, and lists organs
  };

  /// All must outlive this, but builder and inspector must call no more callbacks when this ends.
  /// Without threads, next() does everything itself, so that its results do not depend on when
  /// another thread is done.
  OrganIntake(OrganRegistry& organs, FailureLog& rejected, std::optional<Threads> threads = {})
      : organs_(organs), rejected_(rejected), threads_(threads) {}
  OrganIntake(const OrganIntake&) = delete;  ///< The subscriptions refer to this.

  /// Subscribes to the topics and advertises the services. Needs threads.
  void subscribe(ros::NodeHandle private_node);

  /// Take a message of a topic. `connection`: the one over which the mesh came.
  void take_mesh(const OrganMeshConstPtr& message, const Connection& connection = {});
  void take_vertices(const OrganVerticesConstPtr& message);
  /// Removes an organ, as a mesh without vertices and triangles does: after the messages that were
  /// taken before. Throws Rejection if there is no such organ.
  void remove(const std::string& organ);

  /// Applies the next message that waits for no mesh. Returns std::nullopt if there is none. A
  /// message that is refused is counted as rejected, except for vertices that come in the first 2 s
  /// before the mesh of their organ: then a simulator is only starting.
  std::optional<OrganUpdate> next();

  OrganMessageCounts counts() const;

  /// In the inspector's thread, because volumes of large organs take milliseconds. It asks the
  /// node's thread only for the shapes. Returns false if the node ends before that has answered.
  bool on_list(ListOrgans::Request& request, ListOrgans::Response& response);
  /// In the node's thread.
  bool on_remove(RemoveOrgan::Request& request, RemoveOrgan::Response& response);

 private:
  void add(OrganMessage message);
  void begin(OrganMessage& message);
  OrganUpdate update_by(OrganMessage message);
  OrganChange apply(OrganMessage& message);
  void inspect(const DeformableOrgan& organ);
  void count(const Rejection& rejection);

  OrganRegistry& organs_;
  FailureLog& rejected_;
  std::optional<Threads> threads_;
  /// By organ, in the order in which they came: the first may be being built. No list is empty.
  std::map<std::string, std::deque<OrganMessage>> messages_;
  OrganMessageCounts counts_;  ///< without waiting
  /// The numbers of the last messages, by publisher.
  std::map<std::string, std::uint32_t> meshes_, vertices_;
  SurfaceLog log_;  ///< for the inspector
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> services_;
};

/// How many messages of a publisher were lost on the way between its last one and the one with this
/// number, which becomes the last one. `last`: by publisher. roscpp and rospy number the messages
/// of a topic one after another. A number that is not above the last one is of a publisher that
/// started again.
std::uint64_t lost_before(std::map<std::string, std::uint32_t>& last, const std::string& publisher,
                          std::uint32_t number);

}  // namespace organ_collision
