#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include "wide_integer.hpp"

namespace organ_collision {

template <std::size_t kLimbs>
using WideVector = std::array<WideInteger<kLimbs>, 3>;

template <std::size_t kLimbs>
WideInteger<kLimbs> dot(const WideVector<kLimbs>& a, const WideVector<kLimbs>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <std::size_t kLimbs>
WideVector<kLimbs> cross(const WideVector<kLimbs>& a, const WideVector<kLimbs>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A grid with a power of two as its spacing, on which given points lie exactly. Vectors between
/// them are integers in units of the spacing.
class ExactGrid {
 public:
  /// The points are finite and their coordinates below 2^20 m, a little more than
  /// tolerance::kFarthest.
  explicit ExactGrid(std::initializer_list<Eigen::Vector3d> points);

  /// Limbs that are enough for the triple products of most points, and of all legal points. If
  /// coordinates have b binary digits on the grid, the sum of three products of three differences
  /// has less than 3 b + 6. 63 more are left for the sign and for ratio().
  static constexpr std::size_t kFewLimbs = 6, kManyLimbs = 56;
  /// Whether kFewLimbs are enough.
  bool is_coarse() const { return 3 * digits_ + 69 <= static_cast<int>(64 * kFewLimbs); }

  /// The vector from one of the points to another.
  template <std::size_t kLimbs>
  WideVector<kLimbs> difference(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return {integer<kLimbs>(to.x()) - integer<kLimbs>(from.x()),
            integer<kLimbs>(to.y()) - integer<kLimbs>(from.y()),
            integer<kLimbs>(to.z()) - integer<kLimbs>(from.z())};
  }

 private:
  template <std::size_t kLimbs>
  WideInteger<kLimbs> integer(double coordinate) const {
    int exponent;
    const double fraction = std::frexp(coordinate, &exponent);
    const int spacings = exponent - exponent_;
    // A number below 2^53 spacings is an integer in double precision.
    constexpr int kDigits = std::numeric_limits<double>::digits;
    if (spacings <= kDigits) {
      return WideInteger<kLimbs>(static_cast<std::int64_t>(std::ldexp(fraction, spacings)));
    }
    return WideInteger<kLimbs>(static_cast<std::int64_t>(std::ldexp(fraction, kDigits)),
                               spacings - kDigits);
  }

  int exponent_ = 0;  ///< the spacing is 2 to the power of this [m]
  int digits_ = 0;    ///< the number of binary digits of the largest coordinate
};

}  // namespace organ_collision
