#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// The axis of a tool's shaft at one time, in the organ's frame [m]. The shaft is a capsule: all
/// points within its radius of the axis. If trocar and tip coincide, the shaft is a ball.
struct ShaftAxis {
  Eigen::Vector3d trocar;  ///< where the axis begins
  Eigen::Vector3d tip;     ///< where the axis ends

  /// The point of the axis at `place` in [0, 1], from trocar to tip.
  Eigen::Vector3d at(double place) const { return trocar + place * (tip - trocar); }
};

/// One leg of a shaft's path: both ends of the axis move linearly from `start` to `end`.
struct ShaftMotion {
  ShaftAxis start;  ///< the axis at time 0
  ShaftAxis end;    ///< the axis at time 1

  /// The axis at `time` in [0, 1] of the leg.
  ShaftAxis at(double time) const {
    return {start.trocar + time * (end.trocar - start.trocar),
            start.tip + time * (end.tip - start.tip)};
  }
};

}  // namespace organ_collision
