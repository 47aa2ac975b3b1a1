#include "haptic_proxy/force_ramp.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

namespace {

/// [ms] after some moment of the steady clock.
ForceRamp::Time at(double milliseconds) {
  return ForceRamp::Time(std::chrono::hours(7)) +
         std::chrono::duration_cast<ForceRamp::Time::duration>(
             std::chrono::duration<double, std::milli>(milliseconds));
}

}  // namespace

TEST(ForceRamp, RisesFromZeroWhenItIsFirstAsked) {
  ForceRamp ramp;
  EXPECT_EQ(ramp.share(), 0.0);
  EXPECT_EQ(ramp.rise(at(0.0)), 0.0);
  EXPECT_NEAR(ramp.rise(at(4.0)), 0.4, 1e-9);
  EXPECT_NEAR(ramp.rise(at(7.0)), 0.7, 1e-9);
  EXPECT_EQ(ramp.rise(at(25.0)), 1.0);
  EXPECT_EQ(ramp.share(), 1.0);
}

TEST(ForceRamp, FallsToZeroInTenMilliseconds) {
  ForceRamp ramp;
  ramp.rise(at(0.0));
  ramp.rise(at(20.0));
  EXPECT_EQ(ramp.fall(at(120.0)), 1.0) << "until now it rose";
  EXPECT_NEAR(ramp.fall(at(123.0)), 0.7, 1e-9);
  EXPECT_NEAR(ramp.fall(at(129.0)), 0.1, 1e-9);
  EXPECT_EQ(ramp.fall(at(131.0)), 0.0);
}

TEST(ForceRamp, TurnsWithoutAJump) {
  ForceRamp ramp;
  ramp.rise(at(0.0));
  ramp.rise(at(20.0));
  ramp.fall(at(21.0));
  EXPECT_NEAR(ramp.rise(at(27.0)), 0.4, 1e-9);
  EXPECT_NEAR(ramp.rise(at(29.0)), 0.6, 1e-9);
}

TEST(ForceRamp, ALongTimeAtZeroIsNoRise) {
  ForceRamp ramp;
  ramp.rise(at(0.0));
  ramp.fall(at(20.0));
  ramp.fall(at(40.0));
  EXPECT_EQ(ramp.rise(at(5000.0)), 0.0);
}
