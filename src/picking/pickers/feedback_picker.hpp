#pragma once

#include "picker.hpp"
#include "picking/culling/draw_list.hpp"

namespace organ_collision {

/// Picks in GL_FEEDBACK mode, with one draw call for all faces that outcodes do not decide.
class FeedbackPicker : public Picker {
 public:
  explicit FeedbackPicker(GlContext& context) : context_(context) {}

  void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
            std::vector<Candidate>& candidates) override;
  void pick(const PartSweep& part, const OrganMotion& organ,
            std::vector<Candidate>& candidates) override;

 private:
  void clip(const ViewingVolume& volume, std::vector<Candidate>& candidates);

  GlContext& context_;
  DrawList draw_list_;
  std::vector<float> buffer_ = std::vector<float>(4096);
};

}  // namespace organ_collision
