#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <type_traits>

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
  ExactGrid(std::initializer_list<Eigen::Vector3d> points);

  /// Calls use(limbs) with a constant: how many limbs the triple products of these points need. If
  /// coordinates have b binary digits on the grid, the sum of three products of three differences
  /// has less than 3 b + 6. 63 more are left for the sign and for ratio(). The first number is
  /// enough for most points, the second one for points with a coordinate that is nearly zero, and
  /// the last one for all legal points.
  template <typename Use>
  auto with_limbs(const Use& use) const {
    const int bits = 3 * digits_ + 69;
    if (bits <= 64 * 6) return use(Limbs<6>());
    if (bits <= 64 * 12) return use(Limbs<12>());
    return use(Limbs<56>());
  }

  /// The vector from one of the points to another.
  template <std::size_t kLimbs>
  WideVector<kLimbs> difference(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return {integer<kLimbs>(to.x()) - integer<kLimbs>(from.x()),
            integer<kLimbs>(to.y()) - integer<kLimbs>(from.y()),
            integer<kLimbs>(to.z()) - integer<kLimbs>(from.z())};
  }

 private:
  template <std::size_t kLimbs>
  using Limbs = std::integral_constant<std::size_t, kLimbs>;

  template <std::size_t kLimbs>
  WideInteger<kLimbs> integer(double coordinate) const {
    int exponent;
    const auto digits = static_cast<std::int64_t>(kTwoToDigits * std::frexp(coordinate, &exponent));
    const int shift = exponent - kDigits - exponent_;
    if (shift >= 0) return WideInteger<kLimbs>(digits, shift);
    // The last digits are zeros.
    return WideInteger<kLimbs>(digits / (std::int64_t{1} << std::min(-shift, kDigits)));
  }

  /// Of a double.
  static constexpr int kDigits = std::numeric_limits<double>::digits;
  static constexpr double kTwoToDigits = 0x1p53;

  int exponent_ = 0;  ///< the spacing is 2 to the power of this [m]
  int digits_ = 0;    ///< the number of binary digits of the largest coordinate
};

}  // namespace organ_collision
