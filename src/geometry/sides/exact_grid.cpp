#include "exact_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace organ_collision {
namespace {

/// A double as digits * 2^exponent. The last one of the digits is 1, except for zero.
struct BinaryNumber {
  explicit BinaryNumber(double number) {
    constexpr int kDigits = std::numeric_limits<double>::digits;
    if (number == 0.0) return;
    digits = static_cast<std::int64_t>(std::ldexp(std::frexp(number, &exponent), kDigits));
    const int zeros = std::ilogb(static_cast<double>(digits & -digits));
    digits /= std::int64_t{1} << zeros;
    exponent += zeros - kDigits;
  }

  std::int64_t digits = 0;
  int exponent = 0;
};

}  // namespace

ExactGrid::ExactGrid(std::initializer_list<Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& point : points) {
    for (const double coordinate : {point.x(), point.y(), point.z()}) {
      exponent_ = std::min(exponent_, BinaryNumber(coordinate).exponent);
    }
  }
}

ExactInteger ExactGrid::integer(double coordinate) const {
  const BinaryNumber number(coordinate);
  if (number.digits == 0) return 0;
  return ExactInteger(number.digits) << (number.exponent - exponent_);
}

}  // namespace organ_collision
