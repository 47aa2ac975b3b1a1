#include "ros/publishing/counters.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

TEST(EventRate, CountsSinceTheLastLook) {
  using std::chrono::milliseconds;
  const EventRate::Time start{milliseconds(7000)};
  EventRate rate(start);
  for (int i = 0; i < 30; ++i) rate.count();
  EXPECT_EQ(rate.take(start), 0.0);
  for (int i = 0; i < 30; ++i) rate.count();
  EXPECT_DOUBLE_EQ(rate.take(start + milliseconds(250)), 120.0);
  EXPECT_DOUBLE_EQ(rate.take(start + milliseconds(500)), 0.0);
}

using namespace organ_collision;

TEST(ServiceStatistics, CountsQueriesAndBatchesApart) {
  ServiceStatistics statistics;
  statistics.add_query(0.002);
  statistics.add_query(0.004);
  statistics.add_motions(16);
  EXPECT_EQ(statistics.summary().batches, 0u);
  statistics.add_motions(3);
  statistics.add_batch();
  const ServiceStatistics::Summary summary = statistics.summary();
  EXPECT_EQ(summary.queries.count, 2u);
  EXPECT_EQ(summary.queries.worst, 0.004);
  EXPECT_EQ(summary.batches, 1u);
  EXPECT_EQ(summary.motions, 19u);
}
