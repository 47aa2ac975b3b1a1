#pragma once

#include <memory>
#include <vector>

#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// Checks whether vertices that count as one are still at one place. Remembers the last shape that
/// it checked, so that only the first query of a shape looks at all seams.
class SeamCheck {
 public:
  /// Whether each vertex is within tolerance::kSeam of the first vertex that was at its place when
  /// the topology was made. The topology is one of the mesh's faces.
  bool seams_hold(const SurfaceTopology& topology, const TriangleMesh& mesh);

 private:
  // They share the ownership of what was checked, so that nothing else can take its address.
  std::shared_ptr<const std::vector<SeamVertex>> seams_;
  SharedVertices vertices_;
  bool hold_ = true;
};

}  // namespace organ_collision
