#pragma once

namespace organ_collision {

/// How far a conservative volume grows beyond the space that the tool sweeps.
struct VolumeMargin {
  double motion = 0.0;  ///< [m] largest distance of a face, at any time, from where it is drawn
  double extent = 0.0;  ///< [m] largest coordinate of any drawn vertex relative to the origin
};

}  // namespace organ_collision
