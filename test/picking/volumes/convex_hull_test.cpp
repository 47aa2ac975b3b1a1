#include "picking/volumes/convex_hull.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace organ_collision {
namespace {

using Eigen::Vector2d;

double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

std::vector<Vector2d> corners_of(const std::array<Vector2d, 4>& points) {
  const ConvexHull hull = convex_hull(points);
  return {hull.begin(), hull.end()};
}

TEST(ConvexHull, ContainsAllPointsAndTurnsLeft) {
  std::mt19937 engine(51);
  for (int i = 0; i < 20'000; ++i) {
    // Points on a coarse grid, so that some coincide and some lie on a line.
    std::uniform_int_distribution<int> coordinate(0, 1 + i % 9);
    std::array<Vector2d, 4> points;
    for (Vector2d& point : points) point = {coordinate(engine), coordinate(engine)};
    const std::vector<Vector2d> corners = corners_of(points);
    ASSERT_FALSE(corners.empty());
    for (std::size_t k = 0; k < corners.size(); ++k) {
      EXPECT_NE(std::find(points.begin(), points.end(), corners[k]), points.end());
      const Vector2d& next = corners[(k + 1) % corners.size()];
      for (const Vector2d& point : points) EXPECT_GE(turn(corners[k], next, point), 0);
      if (corners.size() > 2) {
        EXPECT_GT(turn(corners[k], next, corners[(k + 2) % corners.size()]), 0);
      }
    }
    std::reverse(points.begin(), points.end());
    EXPECT_EQ(corners_of(points), corners);
  }
}

TEST(ConvexHull, OfASegmentAndAPoint) {
  const Vector2d a(0.25, 0.75), b(0.5, -0.25);
  EXPECT_EQ(corners_of({b, a, a, b}), (std::vector<Vector2d>{a, b}));
  EXPECT_EQ(corners_of({a, (a + b) / 2, b, b}), (std::vector<Vector2d>{a, b}));
  EXPECT_EQ(corners_of({b, b, b, b}), (std::vector<Vector2d>{b}));
}

}  // namespace
}  // namespace organ_collision
