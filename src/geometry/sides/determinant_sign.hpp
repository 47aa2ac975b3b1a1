#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// The exact vector from one point to another [m]. It is kept as the two points, because their
/// difference would be rounded. Coordinates are finite and within tolerance::kFarthest, or little
/// beyond; they may be as small as the smallest double.
struct ExactVector {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

/// The sign (-1, 0 or 1) of u · (v × w), exactly. 32-bit vertices and random axes are decided in
/// double precision. Only if the rounding errors could change the sign, integers decide. See
/// doc/geometry.md, Sides and crossings.
int triple_product_sign(const ExactVector& u, const ExactVector& v, const ExactVector& w);

/// The sign of the first component of u × v that is not zero, exactly. 0 if u and v are parallel.
int cross_product_sign(const ExactVector& u, const ExactVector& v);

}  // namespace organ_collision
