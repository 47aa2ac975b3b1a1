#include "organ_collision/geometry/triangle.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const Triangle kTriangle = {Vector3d(0.1, 0.2, 0.5), Vector3d(0.5, 0.2, 0.5),
                            Vector3d(0.1, 0.4, 0.5)};

TEST(Triangle, PointAtBarycentricCoordinates) {
  for (int i = 0; i < 3; ++i) EXPECT_EQ(point_at(kTriangle, Vector3d::Unit(i)), kTriangle[i]);
  EXPECT_TRUE(point_at(kTriangle, {0.0, 0.5, 0.5}).isApprox(Vector3d(0.3, 0.3, 0.5), 1e-15));
}

TEST(Triangle, TwiceAreaPointsOutwardByTheRightHandRule) {
  EXPECT_TRUE(twice_area(kTriangle).isApprox(Vector3d(0.0, 0.0, 0.08), 1e-14));
  EXPECT_EQ(twice_area({kTriangle[0], kTriangle[1], kTriangle[1]}), Vector3d::Zero());
}

TEST(Triangle, LargestCoordinateIsAbsolute) {
  EXPECT_EQ(largest_coordinate(kTriangle), 0.5);
  EXPECT_EQ(largest_coordinate({kTriangle[0], kTriangle[1], Vector3d(0.0, -2.0, 0.0)}), 2.0);
}

}  // namespace
}  // namespace organ_collision
