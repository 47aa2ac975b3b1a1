#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "picker.hpp"
#include "picking/culling/draw_list.hpp"
#include "picking/gl/drawing.hpp"
#include "picking/gl/gl_context.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

inline void sort_by_face(std::vector<Candidate>& candidates) {
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.face < b.face; });
}

/// Lets GL draw the witness last, unless it has to draw nothing.
inline void add_witness(const ViewingVolume& volume, DrawList& list) {
  if (!list.faces().empty()) list.add(middle_face(volume), kWitness);
}

/// Replaces `candidates` by all faces that GL was to decide on.
inline void take_drawn(const DrawList& list, std::vector<Candidate>& candidates) {
  candidates.clear();
  for (std::size_t i = 0; i < list.faces().size(); ++i) {
    const std::uint32_t face = list.faces().number(i);
    if (face != kWitness) candidates.push_back({face, 0.0, 0.0});
  }
}

/// Adds the faces that GL did not decide on. They have no depth range.
inline void add_undrawn(const DrawList& list, std::vector<Candidate>& candidates) {
  for (const std::uint32_t face : list.undrawn()) candidates.push_back({face, 0.0, 0.0});
}

/// Sorts what GL returned, in which there must be no face of a number that the mesh does not have.
inline void sort_returned(std::size_t face_count, GlContext& context,
                          std::vector<Candidate>& candidates) {
  sort_by_face(candidates);
  if (candidates.empty() || candidates.back().face < face_count) return;
  context.fail("OpenGL returns face " + std::to_string(candidates.back().face) + " of " +
               std::to_string(face_count));
}

/// Removes the witness, which GL returns last. Returns whether it was there.
inline bool take_witness(std::vector<Candidate>& candidates) {
  if (candidates.empty() || candidates.back().face != kWitness) return false;
  candidates.pop_back();
  return true;
}

/// Picks in GL_FEEDBACK mode, with one draw call for all faces that outcodes do not decide.
class FeedbackPicker : public Picker {
 public:
  explicit FeedbackPicker(GlContext context) : context_(std::move(context)) {}

  void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
            std::vector<Candidate>& candidates) override;
  void pick(const PartSweep& part, const OrganMotion& organ,
            std::vector<Candidate>& candidates) override;
  void release() override { context_.release(); }
  const std::string& gl_version() const override { return context_.version(); }

 private:
  bool clip(const ViewingVolume& volume, std::vector<Candidate>& candidates);
  void read(std::size_t size, const ViewingVolume& volume,
            std::vector<Candidate>& candidates) const;

  GlContext context_;
  DrawList draw_list_;
  std::vector<float> buffer_ = std::vector<float>(4096);
};

/// Picks in GL_SELECT mode, as the 1999 paper does: each face is drawn under its own name. For a
/// given volume every face is drawn, as in the paper. For a part, only the faces that outcodes do
/// not decide are drawn.
class SelectPicker : public Picker {
 public:
  /// Throws GlError.
  explicit SelectPicker(GlContext context);

  void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
            std::vector<Candidate>& candidates) override;
  void pick(const PartSweep& part, const OrganMotion& organ,
            std::vector<Candidate>& candidates) override;
  void release() override { context_.release(); }
  const std::string& gl_version() const override { return context_.version(); }

 private:
  bool clip(const ViewingVolume& volume, std::vector<Candidate>& candidates);
  std::size_t select(const GlFunctions& gl);
  void read(std::size_t hits, const ViewingVolume& volume,
            std::vector<Candidate>& candidates) const;

  GlContext context_;
  DrawList draw_list_;
  std::vector<std::uint32_t> buffer_;
};

}  // namespace organ_collision
