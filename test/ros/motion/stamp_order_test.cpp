#include "ros/motion/stamp_order.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace organ_collision;

namespace {

using Verdict = StampOrder::Verdict;
constexpr double kTick = 0.001;  // [s]

class StampOrderTest : public testing::Test {
 protected:
  /// Of the next transform, which comes at `now`.
  Verdict judge(double stamp, double now) { return order_.judge(ros::Time(stamp), ros::Time(now)); }
  void jump(double from, double to) { order_.add({ros::Time(from), ros::Time(to)}); }

  StampOrder order_;
};

}  // namespace

TEST_F(StampOrderTest, WithoutAJumpEveryStampIsTaken) {
  for (const double stamp : {1.0, 100.0, 2.0, 2.0, 0.0, 4e9}) {
    EXPECT_EQ(judge(stamp, 1.0), Verdict::kTake);
  }
}

TEST_F(StampOrderTest, StampsFarAheadOfTheClockAreOfTheTimeBefore) {
  judge(49.9, 50.0);
  jump(50.0, 3.0);
  EXPECT_EQ(judge(49.95, 3.0), Verdict::kRefuse);
  EXPECT_EQ(judge(50.0, 3.2), Verdict::kRefuse);
}

TEST_F(StampOrderTest, AFrameThatIsNewMayBeALittleAheadOfTheClock) {
  jump(50.0, 3.0);
  EXPECT_EQ(judge(3.2, 3.0), Verdict::kTake);
  EXPECT_EQ(judge(3.3, 3.1), Verdict::kTake);
  EXPECT_EQ(judge(3.5, 3.2), Verdict::kRefuse);
}

TEST_F(StampOrderTest, OfAShortJumpHalfIsAllowed) {
  jump(3.1, 3.0);
  EXPECT_EQ(judge(3.04, 3.0), Verdict::kTake);
  EXPECT_EQ(judge(3.09, 3.0), Verdict::kRefuse);
}

// A node that was stopped for 0.4 s gets all transforms of that time before the clock goes on.
// Without them, the tool would be swept on another way.
TEST_F(StampOrderTest, OnceTheStampsSteppedBackTheyMayBeFarAheadOfTheClock) {
  judge(49.999, 50.0);
  jump(50.0, 3.0);
  EXPECT_EQ(judge(50.0, 3.0), Verdict::kRefuse);
  EXPECT_EQ(judge(3.0, 3.0), Verdict::kTakeAnew);
  for (double stamp = 3.0 + kTick; stamp < 3.4; stamp += kTick) {
    ASSERT_EQ(judge(stamp, 3.0), Verdict::kTake) << stamp;
  }
}

TEST_F(StampOrderTest, TheStampsMayStepBackBeforeTheClockDoes) {
  judge(49.999, 49.999);
  judge(3.0, 49.999);
  judge(3.001, 49.999);
  jump(50.0, 3.0);
  EXPECT_EQ(judge(3.4, 3.0), Verdict::kTake);
  jump(3.4, 2.0);
  EXPECT_EQ(judge(3.401, 2.0), Verdict::kRefuse) << "that was another jump";
}

TEST_F(StampOrderTest, AStepBackThatFollowedAJumpSaysNothingOfTheNextJump) {
  judge(49.999, 50.0);
  jump(50.0, 3.0);
  judge(3.0, 3.0);
  judge(4.0, 4.0);
  jump(4.0, 2.0);
  EXPECT_EQ(judge(4.001, 2.0), Verdict::kRefuse);
}

TEST_F(StampOrderTest, WhereTheStampsStepBackBehindTakenOnesTheseAreForgotten) {
  judge(9.6, 9.9);
  jump(10.0, 9.7);
  EXPECT_EQ(judge(9.72, 9.7), Verdict::kTake) << "as if the frame had stepped back already";
  EXPECT_EQ(judge(9.8, 9.7), Verdict::kTake);
  EXPECT_EQ(judge(9.7, 9.7), Verdict::kTakeAnew);
  EXPECT_EQ(judge(9.71, 9.7), Verdict::kTake);
}

// Then there is a gap in what was taken.
TEST_F(StampOrderTest, WhenTheClockHasCaughtUpWithRefusedStampsTakenOnesAreForgotten) {
  judge(9.4, 9.9);
  jump(10.0, 9.7);
  EXPECT_EQ(judge(9.75, 9.7), Verdict::kTake);
  EXPECT_EQ(judge(9.86, 9.7), Verdict::kRefuse);
  EXPECT_EQ(judge(9.87, 9.8), Verdict::kRefuse);
  EXPECT_EQ(judge(9.88, 9.9), Verdict::kTakeAnew);
  EXPECT_EQ(judge(10.07, 9.91), Verdict::kRefuse) << "these were of the time before as well";
  EXPECT_EQ(judge(9.7, 9.92), Verdict::kTakeAnew);
  EXPECT_EQ(judge(10.2, 9.93), Verdict::kTake);
}

// A second jump, of which the node is told before the stamps of the first one have come.
TEST_F(StampOrderTest, AStepBackToATimeBetweenTwoJumpsIsNotTheLast) {
  judge(50.0, 50.0);
  jump(50.0, 30.0);
  jump(30.1, 3.0);
  EXPECT_EQ(judge(50.001, 3.0), Verdict::kRefuse);
  EXPECT_EQ(judge(30.0, 3.0), Verdict::kRefuse);
  EXPECT_EQ(judge(30.1, 3.0), Verdict::kRefuse);
  EXPECT_EQ(judge(3.0, 3.0), Verdict::kTakeAnew);
}

// A node that was stopped while the clock jumped back sees only the end of the jump. It gets the
// transforms of both times.
TEST_F(StampOrderTest, WhereTheStampsStepFarBackBehindASmallJumpThoseBeforeAreForgotten) {
  judge(545.292, 545.292);
  jump(545.292, 545.290);
  for (double stamp = 545.293; stamp < 545.7; stamp += kTick) {
    ASSERT_EQ(judge(stamp, 545.290), Verdict::kTake) << stamp;
  }
  EXPECT_EQ(judge(545.0, 545.290), Verdict::kTakeAnew);
  for (double stamp = 545.001; stamp < 545.5; stamp += kTick) {
    ASSERT_EQ(judge(stamp, 545.290), Verdict::kTake) << stamp;
  }
  EXPECT_EQ(judge(545.2, 545.5), Verdict::kTakeAnew);
  EXPECT_EQ(judge(545.0, 545.5), Verdict::kTakeAnew);
  EXPECT_EQ(judge(544.9, 545.5), Verdict::kTake) << "three times for each jump";
}

// While the node was stopped, the clock jumped back twice.
TEST_F(StampOrderTest, BehindALargeJumpStampsThatStepBackAgainAreTakenAnew) {
  judge(102.04, 102.04);
  jump(102.04, 99.336);
  EXPECT_EQ(judge(102.041, 99.336), Verdict::kRefuse);
  EXPECT_EQ(judge(99.443, 99.336), Verdict::kTakeAnew);
  EXPECT_EQ(judge(99.491, 99.336), Verdict::kTake);
  EXPECT_EQ(judge(98.748, 99.336), Verdict::kTakeAnew);
  EXPECT_EQ(judge(98.749, 99.336), Verdict::kTake);
}

TEST_F(StampOrderTest, EachSmallJumpIsWatchedForTwoSeconds) {
  judge(10.0, 10.0);
  jump(10.0, 9.998);
  judge(10.0, 10.0);
  judge(11.9, 11.9);
  jump(11.9, 11.897);
  judge(12.3, 11.9);
  EXPECT_EQ(judge(11.5, 12.1), Verdict::kTakeAnew);
  jump(12.2, 12.199);
  judge(12.2, 12.2);
  judge(14.2, 14.2);
  EXPECT_EQ(judge(13.0, 14.2), Verdict::kTake);
}

// The transforms come before the /clock of the larger jump, as without the small one.
TEST_F(StampOrderTest, ASmallJumpDoesNotChangeWhatFollowsALargerOne) {
  jump(545.300, 545.298);
  EXPECT_EQ(judge(545.300, 545.298), Verdict::kTake);
  EXPECT_EQ(judge(3.0, 545.310), Verdict::kTakeAnew);
  EXPECT_EQ(judge(3.001, 545.310), Verdict::kTake);
  jump(545.310, 3.0);
  EXPECT_EQ(judge(3.4, 3.0), Verdict::kTake);
  jump(3.4, 2.0);
  jump(2.0, 1.999);
  EXPECT_EQ(judge(3.401, 2.0), Verdict::kRefuse) << "the larger jump is being watched";
}

TEST_F(StampOrderTest, StampsThatGoOnThroughSmallJumpsAreTaken) {
  double now = 3.0;
  for (int tick = 0; tick < 1000; ++tick) {  // Every tenth tick, the clock steps back.
    const bool is_back = tick % 10 == 0;
    if (is_back) jump(now, now - 0.3 * kTick);
    now += is_back ? -0.3 * kTick : kTick;
    ASSERT_EQ(judge(now + 2.0 * kTick, now), Verdict::kTake) << tick;
  }
}

// Transforms of each millisecond. Their stamps are then ahead of the clock nearly always.
TEST_F(StampOrderTest, TheClockMayTickRarely) {
  for (const double period : {0.01, 0.1, 0.2}) {
    order_ = StampOrder();
    const auto now = [&](double stamp) { return period * std::floor(stamp / period + 1e-9); };
    for (double stamp = 40.0; stamp < 41.0; stamp += kTick) judge(stamp, now(stamp));
    jump(41.0, 30.0);
    std::size_t anew = 0;
    for (double stamp = 30.0; stamp < 34.0; stamp += kTick) {
      const Verdict verdict = judge(stamp, now(stamp));
      ASSERT_NE(verdict, Verdict::kRefuse) << stamp;
      anew += verdict == Verdict::kTakeAnew;
    }
    EXPECT_EQ(anew, 1U);
  }
}

TEST_F(StampOrderTest, TwoSecondsAfterTheFirstTransformAllHasArrived) {
  judge(49.8, 50.0);
  jump(50.0, 3.0);
  EXPECT_EQ(judge(49.9, 7.0), Verdict::kRefuse) << "it came late, because the node was stopped";
  EXPECT_EQ(judge(49.9, 8.999), Verdict::kRefuse);
  EXPECT_EQ(judge(49.9, 9.0), Verdict::kTakeAnew);
  EXPECT_EQ(judge(9.0, 9.1), Verdict::kTake) << "it may step back as without a jump";
}

// Differences of ros::Time throw if they exceed 2^31 s.
TEST_F(StampOrderTest, StampsMayBeOfAnySize) {
  jump(4e9, 1.0);
  EXPECT_EQ(judge(1.0, 1.0), Verdict::kTake);
  EXPECT_EQ(judge(4e9, 1.0), Verdict::kRefuse);
  EXPECT_EQ(judge(0.0, 1.0), Verdict::kTakeAnew);
  const ros::Time last(0xffffffffU, 0);
  order_.add({last, last});
  EXPECT_EQ(order_.judge(last, last), Verdict::kTake);
}
