#include "feedback_picker.hpp"

#include <algorithm>

#include "feedback.hpp"

namespace organ_collision {

void FeedbackPicker::pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                          std::vector<Candidate>& candidates) {
  candidates.clear();
  draw_list_.assign(volume, mesh);
  const std::size_t size = draw_feedback(context_, volume, draw_list_.vertices(), buffer_);
  // Faces come back in the order drawn; one that was clipped as several primitives in a row.
  for_each_vertex(buffer_, size, [&](const FeedbackVertex& vertex) {
    const double depth = volume.view_depth(vertex.window_depth());
    if (candidates.empty() || candidates.back().face != vertex.face()) {
      candidates.push_back({vertex.face(), depth, depth});
    }
    Candidate& candidate = candidates.back();
    candidate.view_min = std::min(candidate.view_min, depth);
    candidate.view_max = std::max(candidate.view_max, depth);
  });
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.face < b.face; });
}

}  // namespace organ_collision
