#pragma once

#include "organ_collision/picking/picker.hpp"

namespace organ_collision {

/// Picks in GL_SELECT mode as the 1999 paper does: every face is drawn, each under its own name.
class SelectPicker : public Picker {
 public:
  explicit SelectPicker(GlContext& context) : context_(context) {}

  void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
            std::vector<Candidate>& candidates) override;

 private:
  GlContext& context_;
  std::vector<Eigen::Vector3f> vertices_;
  std::vector<std::uint32_t> buffer_ = std::vector<std::uint32_t>(1024);
};

}  // namespace organ_collision
