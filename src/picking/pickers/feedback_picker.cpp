#include "feedback_picker.hpp"

#include <algorithm>

#include "candidates.hpp"
#include "picking/gl/feedback.hpp"

namespace organ_collision {

void FeedbackPicker::pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                          std::vector<Candidate>& candidates) {
  candidates.clear();
  draw_list_.assign(volume, mesh);
  clip(volume, candidates);
  sort_by_face(candidates);
}

void FeedbackPicker::pick(const PartSweep& part, const OrganMotion& organ,
                          std::vector<Candidate>& candidates) {
  candidates.clear();
  clip(draw_list_.assign(part, organ), candidates);
  add_undrawn(draw_list_, candidates);
  sort_by_face(candidates);
}

/// Adds the faces of the draw list that meet the volume.
void FeedbackPicker::clip(const ViewingVolume& volume, std::vector<Candidate>& candidates) {
  const std::size_t size = draw_feedback(context_, volume, draw_list_.vertices(), buffer_);
  // Faces come back in the order drawn. If GL has split a face into several primitives, they follow
  // each other.
  for_each_vertex(buffer_, size, [&](const FeedbackVertex& vertex) {
    const double depth = volume.view_depth(vertex.window_depth());
    if (candidates.empty() || candidates.back().face != vertex.face()) {
      candidates.push_back({vertex.face(), depth, depth});
    }
    Candidate& candidate = candidates.back();
    candidate.view_min = std::min(candidate.view_min, depth);
    candidate.view_max = std::max(candidate.view_max, depth);
  });
}

}  // namespace organ_collision
