#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "first_touch.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tool/tool_surface.hpp"
#include "swept_box.hpp"

namespace organ_collision {

/// A face during one leg, and its first touch when the search has found it.
struct FaceTouch {
  std::uint32_t face;  ///< the number of the face
  FaceMotion motion;
  std::optional<FirstTouch> first;
};

/// Finds the first touches of faces with the surface of a link. All faces go down the surface's
/// tree of boxes together. Only the faces that may reach a box are kept below it. In a leaf, each
/// face that is left is tested against each triangle. Keeps its memory between calls.
class SurfaceTouches {
 public:
  /// Sets the first touch of each of `faces`: when the face first comes within `radius` [m] of the
  /// surface. A face that stays farther away has no first touch. If several triangles touch a face
  /// when the leg begins, the nearest triangle counts, because it is the deepest. If `budget` runs
  /// out, touches are unresolved: the face may not touch at all, or may touch earlier.
  void find(const ToolSurface& surface, const RigidMotion& motion, double radius,
            WorkBudget& budget, std::vector<FaceTouch>& faces);

 private:
  struct DescendingFace {
    LegFace leg;
    FaceTouch* touch;
  };
  class Descent;

  std::vector<DescendingFace> faces_;
  /// Places in faces_: first of all faces, then of the faces near each box on the way down to a
  /// leaf.
  std::vector<std::uint32_t> listed_;
};

}  // namespace organ_collision
