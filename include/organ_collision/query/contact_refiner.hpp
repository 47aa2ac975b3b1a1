#pragma once

#include <optional>

#include "organ_collision/geometry/first_touch.hpp"
#include "organ_collision/query/contact.hpp"

namespace organ_collision {

/// One leg of a step for one face, and where both are when the whole step ends.
struct LegAndEnd {
  ShaftMotion shaft;     ///< of the leg
  FaceMotion face;       ///< of the leg
  double begin, finish;  ///< the leg's share of the step: fractions in [0, 1]
  ShaftAxis shaft_end;   ///< at the end of the step
  Triangle face_end;     ///< at the end of the step
};

/// The contact of a candidate face, by exact distances: none if it stays farther from the axis than
/// `radius` during the leg. Face and view range are left for the caller to set.
std::optional<FaceContact> refine(const LegAndEnd& step, double radius);

}  // namespace organ_collision
