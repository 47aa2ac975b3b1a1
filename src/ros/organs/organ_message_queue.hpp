#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "connection.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// Hands on organ messages, those of each organ in the order in which they came. Large meshes with
/// new triangles are made in a thread of their own first: what comes for that organ meanwhile
/// waits, messages of other organs do not.
class OrganMessageQueue {
 public:
  /// Up to so many faces are made where they are needed; it takes less than a millisecond.
  static constexpr std::size_t kLarge = 10'000;
  /// Of the messages that wait for one organ's mesh, the oldest vertices beyond these are dropped.
  static constexpr std::size_t kMostWaiting = 100;

  struct Callbacks {
    /// Throws MeshError. Called in the inbox's own thread.
    std::function<TriangleMesh(const OrganMeshConstPtr&)> make;
    /// Whether the organ already has the message's triangles, or will refuse them: there is
    /// nothing to make then.
    std::function<bool(const OrganMesh&, const Connection&)> is_known;
    /// Takes a message. `made` gives the mesh, or throws what making it threw; at most once.
    std::function<void(const OrganMeshConstPtr&, const Connection&,
                       const std::function<TriangleMesh()>& made)>
        take;
    std::function<void(const OrganVerticesConstPtr&)> take_vertices;
    /// Called in the inbox's own thread: hand_on has something to do. It may throw bad_alloc.
    std::function<void()> wake;
  };
  explicit OrganMessageQueue(Callbacks callbacks);
  /// Waits for the mesh that is being made; the others are not.
  ~OrganMessageQueue();
  OrganMessageQueue(const OrganMessageQueue&) = delete;
  OrganMessageQueue& operator=(const OrganMessageQueue&) = delete;

  void add(const OrganMeshConstPtr& message, const Connection& connection = {});
  void add(const OrganVerticesConstPtr& message);
  /// Everything that waits for nothing any more. To be called now and then even without a wake.
  /// What a callback throws comes out; what stood behind that message is handed on by the next
  /// call.
  void hand_on();

 private:
  /// One of the two.
  struct Entry {
    OrganMeshConstPtr mesh;
    Connection connection;  ///< of the mesh
    OrganVerticesConstPtr vertices;
    std::future<TriangleMesh> made;  ///< of a large mesh only

    bool is_ready() const;
  };
  using Entries = std::deque<Entry>;

  void add(const std::string& organ, Entry entry);
  void hand_on(Entries& entries);
  void hand_on(Entry& entry) const;
  std::future<TriangleMesh> start_making(const OrganMeshConstPtr& message);
  void make_meshes();
  void wake() const;

  Callbacks callbacks_;
  std::map<std::string, Entries> waiting_;  ///< by organ; only those for which something waits

  std::mutex mutex_;  ///< of the following two
  std::deque<std::packaged_task<TriangleMesh()>> tasks_;
  bool stop_ = false;
  std::condition_variable has_work_;
  std::thread thread_;
};

}  // namespace organ_collision
