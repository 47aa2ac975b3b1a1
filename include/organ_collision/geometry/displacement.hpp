#pragma once

#include <memory>

#include "organ_collision/geometry/triangle_mesh.hpp"

namespace organ_collision {

/// [m] The farthest that any vertex lies from where it was in `before`, which has the same faces;
/// up to two millionths more, and less by nothing that counts (1e-18 m).
double largest_displacement(const TriangleMesh& before, const TriangleMesh& now);

/// The same, remembered for the last two shapes: tools of the same step share it.
class LastDisplacement {
 public:
  /// [m] As largest_displacement.
  double between(const TriangleMesh& before, const TriangleMesh& now);

 private:
  std::weak_ptr<const std::vector<float>> before_, now_;
  double displacement_ = 0.0;
};

}  // namespace organ_collision
