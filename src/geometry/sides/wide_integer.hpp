#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace organ_collision {

/// A signed integer of 64 kLimbs bits, in two's complement. Arithmetic wraps around, so the caller
/// chooses enough bits. Nothing is allocated.
template <std::size_t kLimbs>
class WideInteger {
 public:
  /// number * 2^shift; the shift is not negative.
  explicit WideInteger(std::int64_t number = 0, int shift = 0) {
    const std::size_t first = static_cast<std::size_t>(shift) / 64;
    const int bits = shift % 64;
    const auto extension = static_cast<std::uint64_t>(number < 0 ? -1 : 0);
    std::uint64_t lower = 0;
    for (std::size_t i = first; i < kLimbs; ++i) {
      const std::uint64_t limb = i == first ? static_cast<std::uint64_t>(number) : extension;
      limbs_[i] = bits == 0 ? limb : limb << bits | lower >> (64 - bits);
      lower = limb;
    }
  }

  /// -1, 0 or 1.
  int sign() const {
    if (is_negative()) return -1;
    for (const std::uint64_t limb : limbs_) {
      if (limb != 0) return 1;
    }
    return 0;
  }

  WideInteger operator-() const { return WideInteger() - *this; }

  friend WideInteger operator+(WideInteger a, const WideInteger& b) {
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < kLimbs; ++i) {
      const Double sum = Double{a.limbs_[i]} + b.limbs_[i] + carry;
      a.limbs_[i] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    return a;
  }

  friend WideInteger operator-(WideInteger a, const WideInteger& b) {
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < kLimbs; ++i) {
      const Double difference = Double{a.limbs_[i]} - b.limbs_[i] - borrow;
      a.limbs_[i] = static_cast<std::uint64_t>(difference);
      borrow = static_cast<std::uint64_t>(difference >> 64) & 1U;
    }
    return a;
  }

  friend WideInteger operator*(const WideInteger& a, const WideInteger& b) {
    WideInteger product;
    for (std::size_t i = 0; i < kLimbs; ++i) {
      if (a.limbs_[i] == 0) continue;
      std::uint64_t carry = 0;
      for (std::size_t k = 0; i + k < kLimbs; ++k) {
        const Double sum = Double{a.limbs_[i]} * b.limbs_[k] + product.limbs_[i + k] + carry;
        product.limbs_[i + k] = static_cast<std::uint64_t>(sum);
        carry = static_cast<std::uint64_t>(sum >> 64);
      }
    }
    return product;
  }

  /// The number as mantissa * 2^exponent, with a relative error below 2^-52.
  struct Rounded {
    double mantissa;
    int exponent;
  };
  Rounded rounded() const {
    if (is_negative()) {
      const Rounded opposite = (-*this).rounded();
      return {-opposite.mantissa, opposite.exponent};
    }
    std::size_t top = kLimbs - 1;
    while (top > 1 && limbs_[top] == 0) --top;
    const auto upper = static_cast<double>(limbs_[top]);
    const auto lower = static_cast<double>(limbs_[top - 1]);
    return {0x1p64 * upper + lower, 64 * static_cast<int>(top - 1)};
  }

 private:
  __extension__ using Double = unsigned __int128;

  bool is_negative() const { return limbs_[kLimbs - 1] >> 63 != 0; }

  std::array<std::uint64_t, kLimbs> limbs_ = {};  ///< the lowest one first
};

template <std::size_t kLimbs>
struct Division {
  std::int64_t quotient;  ///< rounded down
  WideInteger<kLimbs> remainder;
};

/// numerator / denominator for numerator >= 0, denominator > 0 and a quotient below 2^63.
template <std::size_t kLimbs>
Division<kLimbs> divide(const WideInteger<kLimbs>& numerator,
                        const WideInteger<kLimbs>& denominator) {
  const auto below = denominator.rounded();
  Division<kLimbs> division{0, numerator};
  // Each estimate is right to about 50 digits of what is left.
  while (true) {
    const auto rest = division.remainder.rounded();
    double part =
        std::floor(std::ldexp(rest.mantissa / below.mantissa, rest.exponent - below.exponent));
    if (division.remainder.sign() < 0) {
      part = std::min(part, -1.0);
    } else if ((division.remainder - denominator).sign() >= 0) {
      part = std::max(part, 1.0);
    } else {
      return division;
    }
    const auto digits = static_cast<std::int64_t>(part);
    division.quotient += digits;
    division.remainder = division.remainder - WideInteger<kLimbs>(digits) * denominator;
  }
}

/// A quotient to 61 binary digits, then rounded to a double. Equal fractions give equal numbers.
/// The denominator is positive. Needs 62 bits more than the larger of both has.
template <std::size_t kLimbs>
double ratio(const WideInteger<kLimbs>& numerator, const WideInteger<kLimbs>& denominator) {
  if (numerator.sign() == 0) return 0.0;
  if (numerator.sign() < 0) return -ratio(-numerator, denominator);
  const auto above = numerator.rounded(), below = denominator.rounded();
  const int exponent =
      std::ilogb(above.mantissa / below.mantissa) + above.exponent - below.exponent;
  const int shift = 61 - exponent;
  const WideInteger<kLimbs> power(1, std::abs(shift));
  const std::int64_t quotient = shift > 0 ? divide(power * numerator, denominator).quotient
                                          : divide(numerator, power * denominator).quotient;
  return std::ldexp(static_cast<double>(quotient), -shift);
}

}  // namespace organ_collision
