#include "geometry/distance/cylinder_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "organ_collision/geometry/tool/link.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// Radius 0.1 m, length 0.3 m, along z.
const ConvexCore kCan = LinkPart::cylinder(Eigen::Isometry3d::Identity(), 0.1, 0.3).core;

TEST(CylinderDistance, OfAFaceInsideIsZero) {
  const Triangle inside = {Vector3d(0.01, 0.02, 0.1), Vector3d(0.02, -0.03, 0.1),
                           Vector3d(-0.01, 0.01, -0.1)};
  EXPECT_EQ(cylinder_closest_points(kCan, inside).distance, 0.0);
}

TEST(CylinderDistance, OfAFaceAboveTheFlatEnd) {
  const Triangle above = {Vector3d(-1.0, -1.0, 0.17), Vector3d(2.0, -1.0, 0.17),
                          Vector3d(-1.0, 2.0, 0.17)};
  const ClosestPoints found = cylinder_closest_points(kCan, above);
  EXPECT_NEAR(found.distance, 0.02, 1e-15);
  EXPECT_TRUE(found.separation.isApprox(Vector3d(0.0, 0.0, 0.02), 1e-13));
}

TEST(CylinderDistance, OfAnEdgeThatPassesTheSide) {
  const Triangle beside = {Vector3d(0.16, -1.0, 0.03), Vector3d(0.16, 1.0, 0.03),
                           Vector3d(2.0, 0.0, 0.03)};
  const ClosestPoints found = cylinder_closest_points(kCan, beside);
  EXPECT_NEAR(found.distance, 0.06, 1e-15);
  EXPECT_TRUE(found.on_core.isApprox(Vector3d(0.1, 0.0, 0.03), 1e-8));
  EXPECT_TRUE(found.barycentric.isApprox(Vector3d(0.5, 0.5, 0.0), 1e-8));
}

TEST(CylinderDistance, OfACornerBeyondTheRim) {
  const Triangle beyond = {Vector3d(0.13, 0.0, 0.19), Vector3d(0.3, 0.1, 0.3),
                           Vector3d(0.3, -0.1, 0.4)};
  const ClosestPoints found = cylinder_closest_points(kCan, beyond);
  EXPECT_NEAR(found.distance, 0.05, 1e-15);
  EXPECT_TRUE(found.on_core.isApprox(Vector3d(0.1, 0.0, 0.15), 1e-14));
  EXPECT_EQ(found.barycentric, Vector3d(1.0, 0.0, 0.0));
}

}  // namespace
}  // namespace organ_collision
