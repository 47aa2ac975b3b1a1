#include "feedback_picker.hpp"

#include <algorithm>

#include "candidates.hpp"
#include "picking/gl/feedback.hpp"
#include "picking/gl/witness.hpp"

namespace organ_collision {

void FeedbackPicker::pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                          std::vector<Candidate>& candidates) {
  draw_list_.assign(volume, mesh);
  add_witness(volume, draw_list_);
  if (!clip(volume, candidates)) {
    fail_if_blind(context_);
    clip(volume, candidates);
  }
  sort_returned(mesh.face_count(), context_, candidates);
}

void FeedbackPicker::pick(const PartSweep& part, const OrganMotion& organ,
                          std::vector<Candidate>& candidates) {
  const ViewingVolume volume = draw_list_.assign(part, organ);
  add_witness(volume, draw_list_);
  if (!clip(volume, candidates)) {
    fail_if_blind(context_);
    take_drawn(draw_list_, candidates);
  }
  add_undrawn(draw_list_, candidates);
  sort_returned(organ.after().face_count(), context_, candidates);
}

/// Replaces `candidates` by the faces of the draw list that meet the volume. Returns whether GL
/// also returned the witness, which is the last one in the list, or nothing had to be drawn.
bool FeedbackPicker::clip(const ViewingVolume& volume, std::vector<Candidate>& candidates) {
  candidates.clear();
  if (draw_list_.faces().empty()) return true;
  const std::size_t size = draw_feedback(context_, volume, draw_list_.faces(), buffer_);
  try {
    read(size, volume, candidates);
  } catch (const GlError& error) {
    context_.fail(error.what());
  }
  return take_witness(candidates);
}

/// Adds all faces in the first `size` floats of the buffer.
void FeedbackPicker::read(std::size_t size, const ViewingVolume& volume,
                          std::vector<Candidate>& candidates) const {
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
