#pragma once

#include <atomic>
#include <memory>
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

  // For any thread, once is_found().

  const SurfaceTopology& topology() const { return *topology_; }
  /// Whether the surface is closed and its faces point inward.
  bool is_inward() const { return inward_; }
  /// [m^3] Signed, see signed_volume(). `vertices`: the present positions [m].
  double volume(const std::vector<float>& vertices) const {
    return signed_volume(*topology_, *faces_, vertices);
  }

 private:
  SharedFaces faces_;
  SharedVertices vertices_;  ///< of the message; released when everything is found
  std::optional<SurfaceTopology> topology_;
  bool inward_ = false;
  std::atomic<bool> found_{false};
};

}  // namespace organ_collision
