#pragma once

#include <Eigen/Core>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <initializer_list>

namespace organ_collision {

/// An integer of any size, for the exact predicates. Only a number of more than 512 bits allocates
/// memory. Numbers become that long only if coordinates span 40 orders of magnitude.
using ExactInteger = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked>,
    boost::multiprecision::et_off>;

/// The quotient of two integers, computed to 62 binary digits and then rounded to a double. Equal
/// fractions give equal doubles. The denominator must be positive.
double ratio(const ExactInteger& numerator, const ExactInteger& denominator);

/// The exact vector between two points of an ExactGrid, in units of its spacing.
using IntegerVector = std::array<ExactInteger, 3>;

inline ExactInteger dot(const IntegerVector& a, const IntegerVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A grid on which given points lie exactly. Its spacing is a power of two, so vectors between the
/// points have integer coordinates in units of the spacing.
class ExactGrid {
 public:
  /// The coarsest grid with a spacing of at most 1 m for these points, which must be finite.
  ExactGrid(std::initializer_list<Eigen::Vector3d> points);

  /// The vector from one of the given points to another one.
  IntegerVector difference(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return {integer(to.x()) - integer(from.x()), integer(to.y()) - integer(from.y()),
            integer(to.z()) - integer(from.z())};
  }

 private:
  ExactInteger integer(double coordinate) const;

  int exponent_ = 0;  ///< the spacing is 2 to the power of exponent_ [m]
};

/// The exact vector from one point to another [m]. It is stored as two points, because their
/// difference would be rounded. Coordinates must be finite and at most a little beyond
/// tolerance::kFarthest. They may be as small as the smallest double.
struct ExactVector {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

/// The sign (-1, 0 or 1) of u · (v × w), exactly. Double precision usually suffices. If its
/// rounding errors could change the sign, the sign is computed with integers instead. See
/// doc/theory/geometry.md, Sides and crossings.
int triple_product_sign(const ExactVector& u, const ExactVector& v, const ExactVector& w);

/// The sign of the first component of u × v that is not zero, exactly. 0 if u and v are parallel.
int cross_product_sign(const ExactVector& u, const ExactVector& v);

}  // namespace organ_collision
