#include "exact_signs.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace organ_collision {

double ratio(const ExactInteger& numerator, const ExactInteger& denominator) {
  constexpr int kDigits = 62;
  if (numerator.is_zero()) return 0.0;
  const ExactInteger magnitude = abs(numerator);
  // With this shift, the integer quotient has kDigits or kDigits + 1 binary digits.
  int shift = kDigits - static_cast<int>(msb(magnitude)) + static_cast<int>(msb(denominator));
  const ExactInteger quotient = shift >= 0 ? ExactInteger((magnitude << shift) / denominator)
                                           : ExactInteger(magnitude / (denominator << -shift));
  auto digits = static_cast<std::int64_t>(quotient);
  if (msb(quotient) == kDigits) {
    digits /= 2;
    --shift;
  }
  const double result = std::ldexp(static_cast<double>(digits), -shift);
  return numerator.sign() < 0 ? -result : result;
}

namespace {

/// A double as digits * 2^exponent. `digits` is odd unless the number is zero.
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

// [1] An upper bound of the error of the triple product, as a share of the sum of the absolute
// values of its six products. At most eight roundings lead to each product and to the sum, so the
// error is below 10 * 2^-53 of it.
constexpr double kRoundingShare = 16.0 / (1LL << 53);
// [m^3] An upper bound of the error that underflow adds. A product below the smallest normal number
// loses up to 2^-1074, and the factors that follow, which are below 2^22, enlarge this loss.
constexpr double kUnderflow = 1e-300;

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

int triple_product_sign(const ExactVector& u, const ExactVector& v, const ExactVector& w) {
  const Eigen::Vector3d a = u.to - u.from, b = v.to - v.from, c = w.to - w.from;
  const double value = a.x() * (b.y() * c.z() - b.z() * c.y()) +
                       a.y() * (b.z() * c.x() - b.x() * c.z()) +
                       a.z() * (b.x() * c.y() - b.y() * c.x());
  const double magnitude = std::abs(a.x()) * (std::abs(b.y() * c.z()) + std::abs(b.z() * c.y())) +
                           std::abs(a.y()) * (std::abs(b.z() * c.x()) + std::abs(b.x() * c.z())) +
                           std::abs(a.z()) * (std::abs(b.x() * c.y()) + std::abs(b.y() * c.x()));
  const double error = kRoundingShare * magnitude + kUnderflow;
  if (value > error) return 1;
  if (value < -error) return -1;
  const ExactGrid grid{u.from, u.to, v.from, v.to, w.from, w.to};
  return dot(grid.difference(u.from, u.to),
             cross(grid.difference(v.from, v.to), grid.difference(w.from, w.to)))
      .sign();
}

int cross_product_sign(const ExactVector& u, const ExactVector& v) {
  const ExactGrid grid{u.from, u.to, v.from, v.to};
  for (const ExactInteger& component :
       cross(grid.difference(u.from, u.to), grid.difference(v.from, v.to))) {
    if (component.sign() != 0) return component.sign();
  }
  return 0;
}

}  // namespace organ_collision
