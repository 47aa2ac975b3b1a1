#pragma once

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// A face whose corners move linearly during one leg of the tool's way [m].
struct FaceMotion {
  Triangle start;
  Triangle end;

  /// The face at `time` in [0, 1] of the leg.
  Triangle at(double time) const;
};

}  // namespace organ_collision
