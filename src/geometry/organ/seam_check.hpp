#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// Checks whether vertices that count as one vertex (SurfaceTopology) are still at one place.
/// Remembers the last shape of up to 32 organs, so that only the first query of a shape looks at
/// all seams.
class SeamCheck {
 public:
  /// Whether each vertex is within tolerance::kSeam of the first vertex that was at its place when
  /// the topology was made. The topology must be that of the mesh's faces.
  bool seams_hold(const SurfaceTopology& topology, const TriangleMesh& mesh);

 private:
  /// The last check of one topology. The weak pointers do not keep an organ alive, and when the
  /// organ is gone, they match no other one.
  struct Checked {
    std::weak_ptr<const std::vector<SeamVertex>> seams;
    std::weak_ptr<const std::vector<float>> vertices;
    bool hold = true;
  };

  /// An entry for each topology. A new topology replaces the oldest entry.
  std::array<Checked, 32> checked_;
  std::size_t next_ = 0;
};

}  // namespace organ_collision
