#include "ros/steps/duration_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace organ_collision;

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

TEST(DurationStatistics, NothingYet) {
  const DurationStatistics::Summary summary = DurationStatistics().summary();
  EXPECT_EQ(summary.count, 0u);
  EXPECT_EQ(summary.worst, 0.0);
}

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
