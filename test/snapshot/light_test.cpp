#include "snapshot/light.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const Colour kTissue{0.6F, 0.2F, 0.1F, 0.7F};

TEST(Light, ComesFromAboveTheLeftShoulder) {
  const auto red = [](const Vector3d& normal) { return lit(kTissue, normal.normalized()).x(); };
  EXPECT_GT(red({-1, 0, 1}), red({1, 0, 1}));
  EXPECT_GT(red({0, 1, 1}), red({0, -1, 1}));
  EXPECT_GT(red({0, 0, 1}), red({1, -1, 0}));
}

TEST(Light, LeavesOpacityAndStaysInRange) {
  for (const Vector3d& normal :
       {Vector3d(0, 0, 1), Vector3d(-1, 0, 0), Vector3d(-0.35, 0.55, 0.75)}) {
    const Colour colour = lit(kTissue, normal.normalized());
    EXPECT_EQ(colour.w(), kTissue.w());
    EXPECT_GT(colour.minCoeff(), 0.0F);
    EXPECT_LE(lit(Colour::Ones(), normal.normalized()).maxCoeff(), 1.0F);
  }
}

}  // namespace
}  // namespace organ_collision
