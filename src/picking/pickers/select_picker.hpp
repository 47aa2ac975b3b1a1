#pragma once

#include "picker.hpp"
#include "picking/culling/draw_list.hpp"

namespace organ_collision {

/// Picks in GL_SELECT mode, as the 1999 paper does: each face is drawn under its own name. For a
/// given volume every face is drawn, as in the paper. For a part, only the faces that outcodes do
/// not decide are drawn.
class SelectPicker : public Picker {
 public:
  explicit SelectPicker(GlContext& context) : context_(context) {}

  void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
            std::vector<Candidate>& candidates) override;
  void pick(const PartSweep& part, const OrganMotion& organ,
            std::vector<Candidate>& candidates) override;

 private:
  template <typename Draw>
  void select(const ViewingVolume& volume, Draw draw_named, std::vector<Candidate>& candidates);

  GlContext& context_;
  DrawList draw_list_;
  std::vector<Eigen::Vector3f> vertices_;
  std::vector<std::uint32_t> buffer_ = std::vector<std::uint32_t>(1024);
};

}  // namespace organ_collision
