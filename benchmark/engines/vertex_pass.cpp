#include "vertex_pass.hpp"

#include <algorithm>

namespace organ_collision::bench {
namespace {

using Eigen::Array3f;
using Eigen::Array4f;
using Vector = Eigen::Map<const Array4f>;

constexpr std::size_t kAhead =
    128;  // [vertices] The processor prefetches by itself only up to the end of a page.

// Reduces four points to one. The three vectors hold x y z x, y z x y and z x y z.
template <typename Pick>
Array3f fold(const Array4f& a, const Array4f& b, const Array4f& c, const Pick& pick) {
  const Array3f first(a[0], a[1], a[2]), second(a[3], b[0], b[1]);
  const Array3f third(b[2], b[3], c[0]), fourth(c[1], c[2], c[3]);
  return pick(pick(first, second), pick(third, fourth));
}

}  // namespace

void VertexPass::fit(const std::vector<float>& vertices) {
  const std::size_t count = vertices.size() / 3;
  low_.resize((count + kBlock - 1) / kBlock);
  high_.resize(low_.size());
  const auto min = [](const Array3f& a, const Array3f& b) -> Array3f { return a.min(b); };
  const auto max = [](const Array3f& a, const Array3f& b) -> Array3f { return a.max(b); };
  const std::size_t full = count / kBlock;
  for (std::size_t block = 0; block < full; ++block) {
    const float* xyz = &vertices[3 * kBlock * block];
    __builtin_prefetch(&vertices[std::min(3 * (kBlock * block + kAhead), vertices.size() - 1)]);
    Array4f a = Vector(xyz), b = Vector(xyz + 4), c = Vector(xyz + 8);
    Array4f a_high = a, b_high = b, c_high = c;
    for (std::size_t i = 12; i < 3 * kBlock; i += 12) {
      const Array4f x = Vector(xyz + i), y = Vector(xyz + i + 4), z = Vector(xyz + i + 8);
      a = a.min(x), b = b.min(y), c = c.min(z);
      a_high = a_high.max(x), b_high = b_high.max(y), c_high = c_high.max(z);
    }
    low_[block] = fold(a, b, c, min);
    high_[block] = fold(a_high, b_high, c_high, max);
  }
  if (full == low_.size()) return;
  const auto rest = Eigen::Map<const Eigen::Array3Xf>(
      &vertices[3 * kBlock * full], 3, static_cast<Eigen::Index>(count - full * kBlock));
  low_[full] = rest.rowwise().minCoeff();
  high_[full] = rest.rowwise().maxCoeff();
}

}  // namespace organ_collision::bench
