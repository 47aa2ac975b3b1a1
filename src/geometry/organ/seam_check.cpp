#include "seam_check.hpp"

#include <algorithm>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {

bool SeamCheck::seams_hold(const SurfaceTopology& topology, const TriangleMesh& mesh) {
  if (topology.seams()->empty()) return true;
  const auto& seams = topology.seams();
  Checked& last = checked(seams);
  if (last.vertices.lock() == mesh.shared_vertices()) return last.hold;
  last.vertices = mesh.shared_vertices();
  last.hold = std::all_of(seams->begin(), seams->end(), [&](const SeamVertex& seam) {
    constexpr double kSeamSquared = tolerance::kSeam * tolerance::kSeam;
    return (mesh.vertex(seam.vertex) - mesh.vertex(seam.first)).squaredNorm() <= kSeamSquared;
  });
  return last.hold;
}

SeamCheck::Checked& SeamCheck::checked(
    const std::shared_ptr<const std::vector<SeamVertex>>& seams) {
  for (Checked& checked : checked_) {
    if (checked.seams.lock() == seams) return checked;
  }
  Checked& place = checked_[next_++ % checked_.size()];
  place = {seams, {}, true};
  return place;
}

}  // namespace organ_collision
