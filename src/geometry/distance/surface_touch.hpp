#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ball_sieve.hpp"
#include "first_touch.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tool/tool_surface.hpp"
#include "swept_box.hpp"

namespace organ_collision {

/// A face during one leg, and its first touch once that is found.
struct FaceTouch {
  std::uint32_t face;  ///< number
  FaceMotion motion;
  std::optional<FirstTouch> first;
};

/// Finds the first touches of faces with the surface of a link. The faces descend the surface's
/// tree of boxes together. Below a box, only the faces that may reach it are kept; in a leaf each
/// of them is tested against each triangle. Keeps its memory between calls.
class SurfaceTouches {
 public:
  /// Sets the first touch of each of `faces`: when the face first comes within `radius` [m] of the
  /// surface. A face that stays farther away has no first touch. If several triangles touch a face
  /// when the leg begins, the nearest one counts, because it is the deepest. If `budget` runs out,
  /// touches are unresolved: the face may not touch at all, or may touch earlier.
  void find(const ToolSurface& surface, const RigidMotion& motion, double radius,
            WorkBudget& budget, std::vector<FaceTouch>& faces);

 private:
  struct DescendingFace {
    BoundedFace bounded;
    FaceTouch* touch;
  };
  class Descent;

  std::vector<DescendingFace> faces_;
  BallSieve sieve_;  ///< with the balls of these faces, under the same numbers
};

}  // namespace organ_collision
