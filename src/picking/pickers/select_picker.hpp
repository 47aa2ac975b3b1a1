#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "picker.hpp"
#include "picking/culling/draw_list.hpp"
#include "picking/gl/gl_context.hpp"

namespace organ_collision {

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
