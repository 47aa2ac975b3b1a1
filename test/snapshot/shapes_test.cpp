#include "snapshot/shapes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <map>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

double volume(const TrianglePoints& points) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    sum += points[i].dot(points[i + 1].cross(points[i + 2])) / 6.0;
  }
  return sum;
}

Eigen::AlignedBox3d box(const TrianglePoints& points) {
  Eigen::AlignedBox3d result;
  for (const Vector3d& point : points) result.extend(point);
  return result;
}

/// Whether each directed edge occurs as often as its opposite.
bool is_closed(const TrianglePoints& points) {
  using Point = std::array<double, 3>;
  const auto key = [](const Vector3d& p) { return Point{p.x(), p.y(), p.z()}; };
  std::map<std::pair<Point, Point>, int> balance;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Point a = key(points[i + j]), b = key(points[i + (j + 1) % 3]);
      ++balance[{a, b}];
      --balance[{b, a}];
    }
  }
  for (const auto& [edge, count] : balance) {
    if (count != 0) return false;
  }
  return true;
}

TEST(Shapes, AreClosedAndFaceOutward) {
  const TrianglePoints an_arrow = arrow({0.7, 0.1, 0.2, 0.3});
  for (const TrianglePoints& shape : {unit_cube(), unit_sphere(), unit_cylinder(), an_arrow}) {
    EXPECT_TRUE(is_closed(shape));
    EXPECT_GT(volume(shape), 0.0);
  }
}

TEST(Shapes, HaveTheirVolumesAndSizes) {
  EXPECT_NEAR(volume(unit_cube()), 1.0, 1e-12);
  EXPECT_NEAR(volume(unit_sphere()), M_PI / 6.0, 0.01);
  EXPECT_NEAR(volume(unit_cylinder()), M_PI / 4.0, 0.01);
  for (const TrianglePoints& shape : {unit_cube(), unit_sphere(), unit_cylinder()}) {
    EXPECT_TRUE(box(shape).center().isZero(1e-12));
    EXPECT_TRUE(box(shape).sizes().isApprox(Vector3d::Ones(), 1e-12));
  }
}

TEST(Shapes, TheArrowLiesAlongX) {
  const TrianglePoints points = arrow({0.7, 0.1, 0.2, 0.3});
  EXPECT_TRUE(box(points).min().isApprox(Vector3d(0.0, -0.15, -0.15), 1e-12));
  EXPECT_TRUE(box(points).max().isApprox(Vector3d(0.9, 0.15, 0.15), 1e-12));
  EXPECT_NEAR(volume(points), M_PI * (0.7 * 0.0025 + 0.2 * 0.0225 / 3.0), 1e-4);
}

}  // namespace
}  // namespace organ_collision
