#include "forces/force_limit.hpp"

#include <gtest/gtest.h>

#include <limits>

using namespace organ_collision;

namespace {

/// Two forces with the sum (3, 0, -4).
std::vector<FaceForce> forces() {
  std::vector<FaceForce> forces(2);
  forces[0].force = {5.0, 1.0, -4.0};
  forces[1].force = {-2.0, -1.0, 0.0};
  return forces;
}

}  // namespace

TEST(ForceLimit, TheSumIsLimitedAndAllPartsAreScaledAlike) {
  std::vector<FaceForce> limited = forces();
  EXPECT_TRUE(limit_force(limited, 2.5));
  EXPECT_DOUBLE_EQ(limited[0].force.x(), 2.5);
  EXPECT_DOUBLE_EQ(limited[0].force.z(), -2.0);
  EXPECT_DOUBLE_EQ(limited[1].force.x(), -1.0);
}

TEST(ForceLimit, OthersStayAsTheyAre) {
  for (const double most : {5.0, 6.0, std::numeric_limits<double>::infinity()}) {
    std::vector<FaceForce> same = forces();
    EXPECT_FALSE(limit_force(same, most));
    EXPECT_EQ(same[0].force, forces()[0].force);
    EXPECT_EQ(same[1].force, forces()[1].force);
  }
}
