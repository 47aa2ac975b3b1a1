#include "organ_collision/geometry/tool/shaft.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

const ShaftAxis kBefore{{0.3, -0.1, 0.7}, {0.9, 0.4, -0.2}};
const ShaftAxis kAfter{{0.31, -0.12, 0.73}, {0.2, 0.8, 0.1}};

TEST(ShaftAxis, RunsFromTrocarToTip) {
  EXPECT_EQ(kBefore.at(0.0), kBefore.trocar);
  EXPECT_TRUE(kBefore.at(1.0).isApprox(kBefore.tip, 1e-15));
  EXPECT_TRUE(kBefore.at(0.25).isApprox(0.75 * kBefore.trocar + 0.25 * kBefore.tip, 1e-15));
}

TEST(ShaftMotion, MovesBothEndsLinearly) {
  const ShaftMotion motion{kBefore, kAfter};
  EXPECT_EQ(motion.at(0.0).tip, kBefore.tip);
  EXPECT_TRUE(motion.at(1.0).tip.isApprox(kAfter.tip, 1e-15));
  for (const double time : {0.1, 0.5, 0.9}) {
    const ShaftAxis axis = motion.at(time);
    EXPECT_TRUE(axis.trocar.isApprox((1 - time) * kBefore.trocar + time * kAfter.trocar, 1e-15));
    EXPECT_TRUE(axis.tip.isApprox((1 - time) * kBefore.tip + time * kAfter.tip, 1e-15));
  }
}

}  // namespace
}  // namespace organ_collision
