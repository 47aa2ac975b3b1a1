#include "snapshot/smooth_normals.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

TEST(SmoothNormals, OfABallPointAwayFromItsCentre) {
  TrianglePoints points = unit_sphere();
  const std::vector<Vector3d> normals = smooth_normals(points);
  ASSERT_EQ(normals.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GT(normals[i].dot(points[i].normalized()), 0.999);
  }
}

TEST(SmoothNormals, LeaveTheEdgesOfACubeSharp) {
  const std::vector<Vector3d> normals = smooth_normals(unit_cube());
  for (const Vector3d& normal : normals) EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1.0, 1e-12);
}

TEST(SmoothNormals, OfADegenerateTriangleAreZero) {
  const Vector3d a{0.1, 0.2, 0.3}, b{0.4, 0.1, 0.2}, c{0.3, 0.5, 0.1};
  const std::vector<Vector3d> normals = smooth_normals({a, b, a, a, b, c});
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(normals[i].isZero(0.0));
  const Vector3d expected = (b - a).cross(c - a).normalized();
  for (int i = 3; i < 6; ++i) EXPECT_TRUE(normals[i].isApprox(expected, 1e-12));
}

}  // namespace
}  // namespace organ_collision
