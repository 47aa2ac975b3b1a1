#pragma once

namespace organ_collision {

/// [1] How far 32-bit clipping may misplace the planes of a volume, as shares of the largest
/// coordinate. See doc/geometry.md, Margins.
struct Rounding {
  double plane;     ///< any plane
  double division;  ///< the far plane of a perspective camera in addition: this times far / near
};

// Faces aimed at the boundary were missed with a tenth of the first value, and with a sixteenth of
// the second. The rest is a safety margin.
inline constexpr Rounding kClippingRounding{1e-6, 16.0 / (1 << 24)};
inline constexpr Rounding kNoRounding{0.0, 0.0};

}  // namespace organ_collision
