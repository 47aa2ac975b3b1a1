#include "organ_collision/geometry/surface_touch.hpp"

#include <algorithm>

#include "organ_collision/geometry/swept_box.hpp"

namespace organ_collision {
namespace {

ConvexCore core_of(const Triangle& triangle) {
  ConvexCore core;
  core.count = 3;
  std::copy(triangle.begin(), triangle.end(), core.points.begin());
  return core;
}

/// Nothing can be earlier.
bool touches_at_start(const FaceTouch& face) { return face.first && face.first->time == 0.0; }

class Descent {
 public:
  using Iterator = std::vector<FaceTouch>::iterator;

  Descent(const ToolSurface& surface, const RigidMotion& motion, double radius)
      : surface_(surface), motion_(motion), radius_(radius) {}

  void visit(std::uint32_t index, Iterator begin, Iterator end) const {
    const ToolSurface::Node& node = surface_.nodes()[index];
    const SweptBox box(node.box, motion_, radius_);
    const Iterator kept = std::partition(begin, end, [&](const FaceTouch& face) {
      return !touches_at_start(face) && !box.stays_clear_of(face.motion);
    });
    if (kept == begin) return;
    if (node.second == 0) {
      for (std::uint32_t face = node.begin; face < node.end; ++face) touch(face, begin, kept);
    } else {
      visit(index + 1, begin, kept);
      visit(node.second, begin, kept);
    }
  }

 private:
  void touch(std::uint32_t triangle, Iterator begin, Iterator end) const {
    const CoreMotion core(core_of(surface_.triangle(triangle)), motion_);
    for (Iterator face = begin; face != end; ++face) {
      if (touches_at_start(*face)) continue;
      const double until = face->first ? face->first->time : 1.0;
      const auto found = first_touch(core, face->motion, radius_, until);
      if (found && (!face->first || found->time < until)) face->first = found;
    }
  }

  const ToolSurface& surface_;
  const RigidMotion& motion_;
  double radius_;
};

}  // namespace

void find_first_touches(const ToolSurface& surface, const RigidMotion& motion, double radius,
                        std::vector<FaceTouch>& faces) {
  for (FaceTouch& face : faces) face.first.reset();
  Descent(surface, motion, radius).visit(0, faces.begin(), faces.end());
}

}  // namespace organ_collision
