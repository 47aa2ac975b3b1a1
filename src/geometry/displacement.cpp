#include "organ_collision/geometry/displacement.hpp"

#include <algorithm>
#include <cmath>

namespace organ_collision {

double largest_displacement(const TriangleMesh& before, const TriangleMesh& now) {
  // In 32 bits, four coordinates at a time: x y z x, y z x y, z x y z. Three roundings of squares
  // and sums, and one of each difference, are less than a millionth.
  constexpr double kRounding = 1.0 + 1e-6;
  using Eigen::Array4f;
  const float* const from = before.vertices().data();
  const float* const to = now.vertices().data();
  const auto squares = [&](std::size_t i) -> Array4f {
    return (Eigen::Map<const Array4f>(to + i) - Eigen::Map<const Array4f>(from + i)).square();
  };
  const std::size_t size = now.vertices().size();
  Array4f largest = Array4f::Zero();
  std::size_t i = 0;
  for (; i + 12 <= size; i += 12) {
    const Array4f a = squares(i), b = squares(i + 4), c = squares(i + 8);
    const Array4f x(a[0], a[3], b[2], c[1]), y(a[1], b[0], b[3], c[2]), z(a[2], b[1], c[0], c[3]);
    largest = largest.max(x + y + z);
  }
  double most = largest.maxCoeff();
  for (; i < size; i += 3) {
    const Eigen::Map<const Eigen::Vector3f> a(from + i), b(to + i);
    most = std::max<double>(most, (b - a).squaredNorm());
  }
  return kRounding * std::sqrt(most);
}

double LastDisplacement::between(const TriangleMesh& before, const TriangleMesh& now) {
  // An array that is alive has its address for itself.
  const bool known =
      before_.lock() == before.shared_vertices() && now_.lock() == now.shared_vertices();
  if (!known) {
    displacement_ = largest_displacement(before, now);
    before_ = before.shared_vertices();
    now_ = now.shared_vertices();
  }
  return displacement_;
}

}  // namespace organ_collision
