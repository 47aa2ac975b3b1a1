#include "ros/steps/wait_clock.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;
using std::chrono::milliseconds;
using std::chrono::seconds;

namespace {

class WaitClockTest : public testing::Test {
 protected:
  /// The time of the clock at a simulated time, when the wall clock has gone on.
  SteadyTime at(double simulated, milliseconds later) {
    wall_ += later;
    return clock_.now(ros::Time(simulated), wall_);
  }

  WaitClock clock_;
  SteadyTime wall_{std::chrono::hours(3)};
};

}  // namespace

TEST_F(WaitClockTest, IsTheSteadyClockIfTimeIsNotSimulated) {
  for (int i = 0; i < 3; ++i, wall_ += seconds(7)) {
    EXPECT_EQ(clock_.now(std::nullopt, wall_), wall_);
  }
}

TEST_F(WaitClockTest, FollowsSimulatedTime) {
  const SteadyTime start = at(50.0, milliseconds(0));
  EXPECT_EQ(at(50.25, milliseconds(1)) - start, milliseconds(250));
  EXPECT_EQ(at(50.26, milliseconds(1900)) - start, milliseconds(260));
  EXPECT_EQ(at(50.26, milliseconds(2000)) - start, milliseconds(260));
}

TEST_F(WaitClockTest, TheFirstSimulatedTimeIsNoDuration) {
  const SteadyTime start = at(0.0, milliseconds(0));
  EXPECT_EQ(at(1.7e9, milliseconds(10)), start);
  EXPECT_EQ(at(1.7e9 + 0.5, milliseconds(10)) - start, milliseconds(500));
}

TEST_F(WaitClockTest, NeverGoesBack) {
  const SteadyTime start = at(50.0, milliseconds(0));
  EXPECT_EQ(at(3.0, milliseconds(10)), start);
  EXPECT_EQ(at(3.5, milliseconds(10)) - start, milliseconds(500));
}

TEST_F(WaitClockTest, GoesOnWhenSimulatedTimeStandsStillForLong) {
  const SteadyTime start = at(50.0, milliseconds(0));
  EXPECT_EQ(at(50.0, WaitClock::kStandstill), start);
  EXPECT_EQ(at(50.0, milliseconds(30)) - start, milliseconds(30));
  EXPECT_EQ(at(50.0, milliseconds(40)) - start, milliseconds(70));
  EXPECT_EQ(at(50.1, milliseconds(10)) - start, milliseconds(170));
  EXPECT_EQ(at(50.1, milliseconds(1500)) - start, milliseconds(170));
}
