#pragma once

#include <Eigen/Core>
#include <array>
#include <initializer_list>

#include "exact_integer.hpp"

namespace organ_collision {

/// The exact vector between two points of an ExactGrid, in units of its spacing.
using IntegerVector = std::array<ExactInteger, 3>;

inline ExactInteger dot(const IntegerVector& a, const IntegerVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A grid with a power of two as its spacing, on which given points lie exactly. Vectors between
/// them are integers in units of the spacing.
class ExactGrid {
 public:
  /// The points are finite.
  ExactGrid(std::initializer_list<Eigen::Vector3d> points);

  /// The vector from one of the points to another.
  IntegerVector difference(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return {integer(to.x()) - integer(from.x()), integer(to.y()) - integer(from.y()),
            integer(to.z()) - integer(from.z())};
  }

 private:
  ExactInteger integer(double coordinate) const;

  int exponent_ = 0;  ///< the spacing is 2 to the power of this [m]
};

}  // namespace organ_collision
