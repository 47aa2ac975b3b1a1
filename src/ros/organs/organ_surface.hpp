#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// What is known of an organ's surface as long as its triangles stay the same. A large mesh takes
/// tens of milliseconds, so the node's background thread finds it out (surface_inspector.hpp).
class OrganSurface {
 public:
  /// `mesh`: as its message describes it. The vertices of this shape are welded. Takes no time.
  explicit OrganSurface(const TriangleMesh& mesh)
      : faces_(mesh.shared_faces()), vertices_(mesh.shared_vertices()) {}

  /// Finds out everything. Does nothing if that is done. Only one thread may call this.
  void find();
  /// Whether find() is done. Any thread may call this.
  bool is_found() const { return found_; }
  /// Waits until find() has ended in another thread, but at most for `longest`. Returns
  /// is_found(), which is false after that time, and if find() threw an exception.
  bool wait_until_found(std::chrono::milliseconds longest) const;

  // For any thread, once is_found().

  const SurfaceTopology& topology() const { return *topology_; }
  /// Whether the surface is closed and its faces point inward.
  bool is_inward() const { return inward_; }
  /// [m^3] Signed, see signed_volume(). `vertices`: the present positions [m].
  double volume(const std::vector<float>& vertices) const {
    return signed_volume(*topology_, *faces_, vertices);
  }

 private:
  void find_all();
  void set_ended();

  SharedFaces faces_;
  SharedVertices vertices_;  ///< of the message; released when everything is found
  std::optional<SurfaceTopology> topology_;
  bool inward_ = false;
  std::atomic<bool> found_{false};

  mutable std::mutex mutex_;
  mutable std::condition_variable has_ended_;
  bool ended_ = false;  ///< find() has succeeded or failed; guarded by mutex_
};

}  // namespace organ_collision
