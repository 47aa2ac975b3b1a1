#pragma once

#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// A face whose corners move linearly during one leg of the tool's path [m].
struct FaceMotion {
  Triangle start;
  Triangle end;

  /// The face at `time` in [0, 1] of the leg.
  Triangle at(double time) const;
  /// [m] How far the corner that moves farthest moves.
  double farthest_move() const;
  /// [m] The largest absolute coordinate of the corners at both ends of the leg.
  double largest_coordinate() const;
};

}  // namespace organ_collision
