#include "geometry/distance/triangle_projection.hpp"

#include <gtest/gtest.h>

#include "organ_collision/geometry/triangle.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

std::optional<Vector3d> project(const Vector3d& point, const Triangle& triangle) {
  return project_origin(triangle[0] - point, triangle[1] - point, triangle[2] - point,
                        twice_area(triangle));
}

Triangle random_triangle(oracle::Random& random) {
  return {random.point(0.3), random.point(0.3), random.point(0.3)};
}

TEST(TriangleProjection, FindsTheFootOfPointsAboveTheInside) {
  oracle::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Triangle triangle = random_triangle(random);
    Vector3d barycentric(random.uniform(0.01, 1.0), random.uniform(0.01, 1.0),
                         random.uniform(0.01, 1.0));
    barycentric /= barycentric.sum();
    const Vector3d normal = twice_area(triangle).normalized();
    const Vector3d point = point_at(triangle, barycentric) + random.uniform(-0.2, 0.2) * normal;
    const auto found = project(point, triangle);
    ASSERT_TRUE(found);
    EXPECT_LE((point_at(triangle, *found) - point_at(triangle, barycentric)).norm(), 1e-11);
  }
}

TEST(TriangleProjection, RefusesPointsBesideTheTriangle) {
  oracle::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Triangle triangle = random_triangle(random);
    Vector3d barycentric(random.uniform(0.01, 1.0), random.uniform(0.01, 1.0), 0.0);
    barycentric[2] = 1.0 - barycentric.sum() + 1.0;
    barycentric[i % 3] = random.uniform(-1.0, -0.01);
    barycentric /= barycentric.sum();
    if (!(barycentric.minCoeff() < -0.01)) continue;
    EXPECT_FALSE(project(point_at(triangle, barycentric), triangle));
  }
}

TEST(TriangleProjection, RefusesDegenerateTriangles) {
  const Vector3d a(0.1, 0.2, 0.3), b(0.4, 0.5, 0.6);
  EXPECT_FALSE(project({0.0, 0.0, 0.0}, {a, a, a}));
  EXPECT_FALSE(project({0.0, 0.0, 0.0}, {a, b, a}));
}

}  // namespace
}  // namespace organ_collision
