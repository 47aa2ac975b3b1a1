#pragma once

#include <cmath>

namespace organ_collision {

/// A quadratic polynomial over [0, 1] by its Bernstein coefficients: the values at both ends, and
/// the control value between them.
struct BernsteinQuadratic {
  double start, middle, end;
};

/// The first root in (0, 1] of a quadratic whose value at the start is positive; 2 if it has no
/// such root.
inline double first_root(const BernsteinQuadratic& quadratic) {
  const auto& [start, middle, end] = quadratic;
  if (middle >= 0.0 && end > 0.0) return 2.0;  // The control polygon stays positive.
  const double half_linear = middle - start;
  const double square = start - 2.0 * middle + end;
  const double discriminant = half_linear * half_linear - square * start;
  if (discriminant < 0.0) return 2.0;
  const double root = std::sqrt(discriminant);
  // The solution has two equivalent forms. The sign of half_linear decides which one does not
  // cancel digits.
  const double place =
      half_linear < 0.0 ? start / (root - half_linear) : -(root + half_linear) / square;
  return place >= 0.0 && place <= 1.0 ? place : 2.0;
}

}  // namespace organ_collision
