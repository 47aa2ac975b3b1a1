#include "convex_hull.hpp"

#include <algorithm>

namespace organ_collision {
namespace {

using Eigen::Vector2d;

bool turns_left(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d ab = b - a;
  const Vector2d ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x() > 0;
}

// Adds the corners from the first point to the last, without the last.
template <typename Iterator>
void add_chain(Iterator first, Iterator last, std::vector<Vector2d>& corners) {
  const std::size_t begin = corners.size();
  for (; first != last; ++first) {
    while (corners.size() >= begin + 2 &&
           !turns_left(corners[corners.size() - 2], corners.back(), *first)) {
      corners.pop_back();
    }
    corners.push_back(*first);
  }
  corners.pop_back();
}

}  // namespace

// Follows Andrew, "Another efficient algorithm for convex hulls in two dimensions" (1979).
std::vector<Vector2d> convex_hull(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 2) return points;
  std::vector<Vector2d> corners;
  add_chain(points.begin(), points.end(), corners);
  add_chain(points.rbegin(), points.rend(), corners);
  return corners;
}

}  // namespace organ_collision
