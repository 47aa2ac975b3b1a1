#include "ros/steps/step_history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "ros/steps/duration_statistics.hpp"

using namespace organ_collision;
using std::chrono::milliseconds;
using std::chrono::seconds;

namespace {

LastStep step(int second) {
  return {{{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}}, ros::Time(second), nullptr};
}

}  // namespace

TEST(StepHistory, KeptToolsAreNumberedAnewAndOthersForgotten) {
  StepHistory history;
  for (const char* organ : {"kidney", "liver"}) {
    for (int tool = 0; tool < 3; ++tool) history.of(organ, tool).last = step(10 + tool);
  }
  history.renumber({std::nullopt, 2, 0, std::nullopt});
  EXPECT_EQ(history.pairs().size(), 4u);
  for (const char* organ : {"kidney", "liver"}) {
    EXPECT_EQ(history.last(organ, 0), nullptr);
    EXPECT_EQ(history.last(organ, 1)->stamp, ros::Time(12));
    EXPECT_EQ(history.last(organ, 2)->stamp, ros::Time(10));
    EXPECT_EQ(history.last(organ, 3), nullptr);
  }
}

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

namespace {

/// The smallest value that at least `percent` percent of all values do not exceed, by counting.
double percentile_oracle(const std::vector<double>& values, double percent) {
  double best = *std::max_element(values.begin(), values.end());
  for (const double value : values) {
    const auto covered =
        std::count_if(values.begin(), values.end(), [&](double other) { return other <= value; });
    if (100.0 * static_cast<double>(covered) >= percent * static_cast<double>(values.size())) {
      best = std::min(best, value);
    }
  }
  return best;
}

}  // namespace

TEST(DurationStatistics, KnowsTheLatest) {
  DurationStatistics statistics;
  EXPECT_EQ(statistics.latest(), 0.0);
  for (std::size_t i = 0; i <= DurationStatistics::kCapacity; ++i) {
    statistics.add(1e-6 * i);
    EXPECT_EQ(statistics.latest(), 1e-6 * i);
  }
}

TEST(DurationStatistics, AgreesWithCounting) {
  std::mt19937 random(2);
  std::lognormal_distribution<double> duration(-9.0, 1.0);
  for (const std::size_t size : {1, 2, 3, 99, 100, 101, 500}) {
    DurationStatistics statistics;
    std::vector<double> values(size);
    for (double& value : values) statistics.add(value = duration(random));
    const DurationStatistics::Summary summary = statistics.summary();
    EXPECT_EQ(summary.count, size);
    EXPECT_EQ(summary.median, percentile_oracle(values, 50.0)) << size;
    EXPECT_EQ(summary.percentile_99, percentile_oracle(values, 99.0)) << size;
    EXPECT_EQ(summary.worst, *std::max_element(values.begin(), values.end()));
  }
}

TEST(DurationStatistics, ForgetsTheOldest) {
  DurationStatistics statistics;
  statistics.add(100.0);
  for (std::size_t i = 0; i < DurationStatistics::kCapacity - 1; ++i) statistics.add(1.0);
  EXPECT_EQ(statistics.summary().worst, 100.0);
  statistics.add(2.0);
  EXPECT_EQ(statistics.summary().worst, 2.0);
  EXPECT_EQ(statistics.summary().count, DurationStatistics::kCapacity + 1);
}
