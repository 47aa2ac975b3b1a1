#include "exact_clip.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

/// A face has three corners; each half-space adds at most one.
struct Polygon {
  std::array<Vector3d, 3 + 32> corner;
  std::size_t size = 0;

  void add(const Vector3d& point) { corner[size++] = point; }
};

double excess(const HalfSpace& half_space, const Vector3d& point) {
  return half_space.normal.dot(point) - half_space.offset;
}

// Sutherland and Hodgman 1974.
void clip(const Polygon& polygon, const HalfSpace& half_space, Polygon& inside) {
  inside.size = 0;
  const Vector3d* from = &polygon.corner[polygon.size - 1];
  double from_excess = excess(half_space, *from);
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vector3d* to = &polygon.corner[i];
    const double to_excess = excess(half_space, *to);
    if ((from_excess < 0.0 && to_excess > 0.0) || (from_excess > 0.0 && to_excess < 0.0)) {
      inside.add(*from + (*to - *from) * (from_excess / (from_excess - to_excess)));
    }
    if (to_excess <= 0.0) inside.add(*to);
    from = to;
    from_excess = to_excess;
  }
}

}  // namespace

bool meets(const Triangle& face, const std::vector<HalfSpace>& half_spaces) {
  std::array<std::uint32_t, 3> outside = {0, 0, 0};
  for (std::size_t k = 0; k < half_spaces.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      outside[i] |= static_cast<std::uint32_t>(excess(half_spaces[k], face[i]) > 0.0) << k;
    }
  }
  if (outside[0] & outside[1] & outside[2]) return false;
  if (outside[0] == 0 || outside[1] == 0 || outside[2] == 0) return true;

  std::array<Polygon, 2> polygons;
  Polygon *polygon = &polygons[0], *clipped = &polygons[1];
  for (const Vector3d& corner : face) polygon->add(corner);
  const std::uint32_t crossed = outside[0] | outside[1] | outside[2];
  for (std::size_t k = 0; k < half_spaces.size(); ++k) {
    if (!(crossed >> k & 1U)) continue;
    clip(*polygon, half_spaces[k], *clipped);
    if (clipped->size == 0) return false;
    std::swap(polygon, clipped);
  }
  return true;
}

}  // namespace organ_collision::bench
