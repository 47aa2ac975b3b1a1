#include "convex_hull.hpp"

#include <algorithm>
#include <iterator>

namespace organ_collision {
namespace {

using Eigen::Vector2d;

bool turns_left(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d ab = b - a;
  const Vector2d ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x() > 0;
}

// Adds the corners on one side of the hull, from the first point to the last. The last is left out.
template <typename Iterator>
void add_chain(Iterator first, Iterator last, ConvexHull& hull) {
  std::array<Vector2d, 4> chain;
  std::size_t count = 0;
  for (; first != last; ++first) {
    while (count >= 2 && !turns_left(chain[count - 2], chain[count - 1], *first)) --count;
    chain[count++] = *first;
  }
  for (std::size_t i = 0; i + 1 < count; ++i) hull.corners[hull.count++] = chain[i];
}

}  // namespace

// Follows Andrew, "Another efficient algorithm for convex hulls in two dimensions" (1979).
ConvexHull convex_hull(std::array<Vector2d, 4> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  const auto end = std::unique(points.begin(), points.end());
  if (end - points.begin() == 1) return {points, 1};
  ConvexHull hull;
  add_chain(points.begin(), end, hull);
  add_chain(std::make_reverse_iterator(end), points.rend(), hull);
  return hull;
}

}  // namespace organ_collision
