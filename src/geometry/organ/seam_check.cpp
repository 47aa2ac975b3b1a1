#include "seam_check.hpp"

#include <algorithm>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {

bool SeamCheck::seams_hold(const SurfaceTopology& topology, const TriangleMesh& mesh) {
  if (topology.seams()->empty()) return true;
  if (seams_ == topology.seams() && vertices_ == mesh.shared_vertices()) return hold_;
  seams_ = topology.seams();
  vertices_ = mesh.shared_vertices();
  hold_ = std::all_of(seams_->begin(), seams_->end(), [&](const SeamVertex& seam) {
    constexpr double kSeamSquared = tolerance::kSeam * tolerance::kSeam;
    return (mesh.vertex(seam.vertex) - mesh.vertex(seam.first)).squaredNorm() <= kSeamSquared;
  });
  return hold_;
}

}  // namespace organ_collision
