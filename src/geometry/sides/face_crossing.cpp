#include "face_crossing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace organ_collision {
namespace {

/// The exponent of the last binary digit of a double; 0 for zero.
int last_exponent(double number) {
  int exponent = 0;
  std::frexp(number, &exponent);
  return number == 0.0 ? 0 : exponent - std::numeric_limits<double>::digits;
}

// [1] An upper bound of the error of the triple product, as a share of the sum of the absolute
// values of its six products. At most eight roundings lead to each product and to the sum, so the
// error is below 10 * 2^-53 of it.
constexpr double kRoundingShare = 16.0 / (1LL << 53);
// [m^3] An upper bound of the error that underflow adds. A product below the smallest normal number
// loses up to 2^-1074, and the factors that follow, which are below 2^22, enlarge this loss.
constexpr double kUnderflow = 1e-300;

/// On which side of the face's plane the point is after the infinitesimal displacement (see
/// crossing_direction()): 1 on the outer side, -1 on the inner side. 0 if the face is degenerate.
int side_of_plane(const Triangle& face, const Eigen::Vector3d& point) {
  const ExactVector first{face[0], face[1]}, second{face[0], face[2]};
  const int side = triple_product_sign(first, second, {face[0], point});
  return side != 0 ? side : cross_product_sign(first, second);
}

/// On which side (1 or -1) the line along the axis passes the edge after the infinitesimal
/// displacement. 0 if axis and edge are parallel.
int side_of_edge(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const ShaftAxis& axis) {
  const ExactVector along{axis.trocar, axis.tip};
  const int side = triple_product_sign(along, {axis.trocar, from}, {from, to});
  return side != 0 ? side : cross_product_sign(along, {from, to});
}

}  // namespace

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

ExactGrid::ExactGrid(std::initializer_list<Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& point : points) {
    for (const double coordinate : {point.x(), point.y(), point.z()}) {
      exponent_ = std::min(exponent_, last_exponent(coordinate));
    }
  }
}

ExactInteger ExactGrid::integer(double coordinate) const {
  const int exponent = last_exponent(coordinate);
  const auto digits = static_cast<std::int64_t>(std::ldexp(coordinate, -exponent));
  return ExactInteger(digits) << (exponent - exponent_);
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

bool is_on_face(const Triangle& face, const Eigen::Vector3d& point) {
  Eigen::AlignedBox3d box(face[0]);
  box.extend(face[1]).extend(face[2]);
  if (!box.contains(point)) return false;
  const ExactVector first{face[0], face[1]}, second{face[0], face[2]};
  if (triple_product_sign(first, second, {face[0], point}) != 0) return false;
  const int normal = cross_product_sign(first, second);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d &from = face[i], &to = face[(i + 1) % 3];
    const int side = cross_product_sign({from, to}, {from, point});
    if (normal == 0) {
      const Eigen::AlignedBox3d edge(from.cwiseMin(to), from.cwiseMax(to));
      if (side == 0 && edge.contains(point)) return true;
    } else if (side == -normal) {
      // Both cross products are parallel to the normal: the signs tell if they point the same way.
      return false;
    }
  }
  return normal != 0;
}

int crossing_direction(const Triangle& face, const ShaftAxis& axis) {
  const int tip = side_of_plane(face, axis.tip);
  if (tip == 0 || tip == side_of_plane(face, axis.trocar)) return 0;
  for (std::size_t i = 0; i < 3; ++i) {
    // An axis that crosses the face passes all three edges on one side: the sign of `tip`.
    if (side_of_edge(face[i], face[(i + 1) % 3], axis) != tip) return 0;
  }
  return -tip;
}

/// Solves, by Cramer's rule, trocar + shaft (tip - trocar) = corner 0 + barycentric 1 (corner 1 -
/// corner 0) + barycentric 2 (corner 2 - corner 0).
FaceCrossing face_crossing(const Triangle& face, const ShaftAxis& axis) {
  const ExactGrid grid{face[0], face[1], face[2], axis.trocar, axis.tip};
  const IntegerVector along = grid.difference(axis.trocar, axis.tip);
  const IntegerVector first = grid.difference(face[0], face[1]);
  const IntegerVector second = grid.difference(face[0], face[2]);
  const IntegerVector to_trocar = grid.difference(face[0], axis.trocar);
  const IntegerVector normal = cross(first, second);
  const IntegerVector moment = cross(along, to_trocar);
  ExactInteger divisor = dot(normal, along), distance = -dot(normal, to_trocar);
  ExactInteger part1 = dot(second, moment), part2 = -dot(first, moment);
  if (divisor.sign() < 0) {
    for (ExactInteger* const number : {&divisor, &distance, &part1, &part2}) *number = -*number;
  }

  FaceCrossing crossing;
  crossing.barycentric = {ratio(divisor - part1 - part2, divisor), ratio(part1, divisor),
                          ratio(part2, divisor)};
  constexpr int kDigits = 62;
  ExactInteger digits, remainder;
  divide_qr(ExactInteger(distance << kDigits), divisor, digits, remainder);
  const auto leading = static_cast<double>(static_cast<std::int64_t>(digits));
  const auto rest =
      static_cast<double>(static_cast<std::int64_t>(digits) - static_cast<std::int64_t>(leading));
  crossing.shaft = std::ldexp(leading, -kDigits);
  crossing.shaft_rest = std::ldexp(rest + ratio(remainder, divisor), -kDigits);
  return crossing;
}

Eigen::Vector3d crossing_shift(const Triangle& face, const ShaftAxis& axis) {
  const ExactGrid grid{face[0], face[1], face[2], axis.trocar, axis.tip};
  const IntegerVector along = grid.difference(axis.trocar, axis.tip);
  const IntegerVector normal =
      cross(grid.difference(face[0], face[1]), grid.difference(face[0], face[2]));
  const ExactInteger divisor = dot(normal, along);
  Eigen::Index longest;
  axis.along().cwiseAbs().maxCoeff(&longest);
  const ExactInteger length = divisor.sign() * abs(along[longest]);
  Eigen::Vector3d shift;
  for (std::size_t i = 0; i < 3; ++i) shift[i] = -ratio(normal[i] * length, abs(divisor));
  return shift;
}

}  // namespace organ_collision
