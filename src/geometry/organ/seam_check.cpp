#include "seam_check.hpp"

#include <algorithm>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {

bool SeamCheck::seams_hold(const SurfaceTopology& topology, const TriangleMesh& mesh) {
  const auto& seams = topology.seams();
  if (seams->empty()) return true;
  auto last = std::find_if(checked_.begin(), checked_.end(),
                           [&](const Checked& checked) { return checked.seams.lock() == seams; });
  if (last == checked_.end()) {
    last = checked_.begin() + next_++ % checked_.size();
    *last = {seams, {}, true};
  }
  if (last->vertices.lock() == mesh.shared_vertices()) return last->hold;
  last->vertices = mesh.shared_vertices();
  last->hold = std::all_of(seams->begin(), seams->end(), [&](const SeamVertex& seam) {
    constexpr double kSeamSquared = tolerance::kSeam * tolerance::kSeam;
    return (mesh.vertex(seam.vertex) - mesh.vertex(seam.first)).squaredNorm() <= kSeamSquared;
  });
  return last->hold;
}

}  // namespace organ_collision
