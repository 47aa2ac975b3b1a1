#pragma once

#include <ros/time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
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

/// Shapes of one organ that share its triangles. The last user of a shape, in whichever thread,
/// gives it back by releasing it. The next shape then takes over its memory, instead of allocating
/// boxes for a large organ again. Shapes may be in use longer than the pool exists.
class ShapePool {
 public:
  ShapePool() : unused_(std::make_shared<Unused>()) {}

  /// A shape that nobody else uses: one that was given back, or else a copy of `model`. It has
  /// the vertices of some earlier shape: move it before it is used.
  std::shared_ptr<TriangleMesh> take(const TriangleMesh& model);
  /// Makes a mesh a shape of this pool.
  std::shared_ptr<TriangleMesh> add(TriangleMesh mesh);

 private:
  /// The shapes that were given back. The shapes in use refer to it, too, so that it outlives them.
  struct Unused {
    std::mutex mutex;
    std::vector<std::unique_ptr<TriangleMesh>> shapes;

    std::unique_ptr<TriangleMesh> take();
    void give_back(std::unique_ptr<TriangleMesh> shape);
  };
  std::shared_ptr<TriangleMesh> lend(std::unique_ptr<TriangleMesh> shape) const;

  std::shared_ptr<Unused> unused_;
};

/// An organ's surface at one time. Its users share it, and it does not change while they use it.
struct OrganShape {
  std::shared_ptr<const TriangleMesh> mesh;  ///< null: no shape
  ros::Time stamp;                           ///< as sent; zero: unstamped
  ros::Time received;
  std::shared_ptr<OrganSurface> surface = {};  ///< of the mesh's triangles; null: no shape

  /// How the mesh's faces join. Null as long as that is not found.
  const SurfaceTopology* topology() const {
    return surface->is_found() ? &surface->topology() : nullptr;
  }

  /// [s] The time since the stamp, or since the message came if it has no stamp, or one that was in
  /// the future then. (Before the first /clock, messages come at time zero, and every stamp
  /// counts.)
  double age(ros::Time now) const {
    const bool is_of_future = received < stamp && !received.isZero();
    return now.toSec() - (stamp.isZero() || is_of_future ? received : stamp).toSec();
  }
};

/// A named organ: its frame, its latest shape and the one before.
class DeformableOrgan {
 public:
  DeformableOrgan(std::string name, std::string frame, TriangleMesh mesh, ros::Time stamp,
                  ros::Time received);

  const std::string& name() const { return name_; }
  const std::string& frame() const { return frame_; }
  const OrganShape& latest() const { return latest_; }
  /// The shape before the latest one. It has no mesh if the latest one is the first of its
  /// topology, or after forget_previous().
  const OrganShape& previous() const { return previous_; }

  /// What is known of the surface. Another object if the triangles change.
  const std::shared_ptr<OrganSurface>& surface() const { return latest_.surface; }

  /// Sets new positions for the same triangles. Throws MeshError, and changes nothing, if they do
  /// not fit. Reuses a shape that nobody uses any more, if there is one.
  void move(SharedVertices vertices, ros::Time stamp, ros::Time received);
  /// Sets a new mesh with other triangles.
  void replace(TriangleMesh mesh, ros::Time stamp, ros::Time received);

  void set_frame(std::string frame) { frame_ = std::move(frame); }
  void forget_previous() { previous_ = {}; }
  /// For a clock that jumped back to `now`, or began: the latest shape counts as received then at
  /// the latest.
  void receive_anew(ros::Time now) {
    const bool came_before_time = latest_.received.isZero();
    latest_.received = came_before_time ? now : std::min(latest_.received, now);
  }

 private:
  std::string name_;
  std::string frame_;
  OrganShape latest_;
  OrganShape previous_;
  ShapePool shapes_;  ///< of the present topology
};

}  // namespace organ_collision
