#include "determinant_sign.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "exact_grid.hpp"

namespace organ_collision {
namespace {

// [1] At most eight roundings lead to each of the six products and to their sum, so the error is
// below 10 * 2^-53 of the sum of their absolute values.
constexpr double kRoundingShare = 16.0 / (1LL << 53);
// [m^3] Products below the smallest normal number lose up to 2^-1074, which later factors below
// 2^22 enlarge.
constexpr double kUnderflow = 1e-300;

}  // namespace

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
