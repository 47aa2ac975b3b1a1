#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "picker.hpp"
#include "picking/culling/draw_list.hpp"
#include "picking/gl/gl_context.hpp"

namespace organ_collision {

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

}  // namespace organ_collision
