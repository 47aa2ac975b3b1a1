#pragma once

namespace organ_collision {

/// [1] How far 32-bit clipping may misplace the planes of a volume, as shares of the largest
/// coordinate. See doc/geometry.md, Outcodes and 32-bit clipping.
struct Rounding {
  double plane;     ///< any plane; for a wedge, this times 1 plus its steeper slope
  double division;  ///< the far plane of a perspective camera in addition: this times far / near
};

// For frustum planes, the derived bound of both is 14.4 / (1 << 24). In tests, faces aimed at the
// boundary were missed with a tenth of the first value, and with a sixteenth of the second.
inline constexpr Rounding kClippingRounding{1e-6, 16.0 / (1 << 24)};
inline constexpr Rounding kNoRounding{0.0, 0.0};

}  // namespace organ_collision
