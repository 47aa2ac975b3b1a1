#include "geometry/organ/face_motion.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const FaceMotion kMotion{
    {Vector3d(0.1, 0.2, 0.3), Vector3d(0.4, 0.1, -0.2), Vector3d(0.0, 0.3, 0.1)},
    {Vector3d(0.1, 0.2, 0.4), Vector3d(0.4, 0.4, -0.6), Vector3d(0.0, 0.3, 0.1)}};

TEST(FaceMotion, MovesItsCornersLinearly) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(kMotion.at(0.0)[i], kMotion.start[i]);
    EXPECT_TRUE(kMotion.at(1.0)[i].isApprox(kMotion.end[i], 1e-15));
    const Vector3d expected = 0.75 * kMotion.start[i] + 0.25 * kMotion.end[i];
    EXPECT_TRUE(kMotion.at(0.25)[i].isApprox(expected, 1e-15));
  }
}

TEST(FaceMotion, FarthestMoveIsThatOfOneCorner) { EXPECT_DOUBLE_EQ(kMotion.farthest_move(), 0.5); }

TEST(FaceMotion, LargestCoordinateIsThatOfBothEnds) {
  EXPECT_EQ(kMotion.largest_coordinate(), 0.6);
  EXPECT_EQ((FaceMotion{kMotion.end, kMotion.start}.largest_coordinate()), 0.6);
}

}  // namespace
}  // namespace organ_collision
