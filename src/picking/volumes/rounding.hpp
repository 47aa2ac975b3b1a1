#pragma once

namespace organ_collision {

/// How far a volume grows for what 32-bit clipping loses, as shares of the largest coordinate [1].
struct Rounding {
  double plane;     ///< every plane is misplaced by up to this
  double division;  ///< the far plane by this times far / near as well
};

// Measured with faces aimed at the boundary: a tenth of the first is too little, and a sixteenth of
// the second. The rest is margin.
inline constexpr Rounding kCovered{1e-6, 16.0 / (1 << 24)};
inline constexpr Rounding kIgnored{0.0, 0.0};

}  // namespace organ_collision
