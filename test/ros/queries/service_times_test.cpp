#include "ros/queries/service_times.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

TEST(ServiceTimes, CountsQueriesAndBatchesApart) {
  ServiceTimes times;
  times.add_query(0.002);
  times.add_query(0.004);
  times.add_motions(16);
  EXPECT_EQ(times.summary().batches, 0u);
  times.add_motions(3);
  times.add_batch();
  const ServiceTimes::Summary summary = times.summary();
  EXPECT_EQ(summary.queries.count, 2u);
  EXPECT_EQ(summary.queries.worst, 0.004);
  EXPECT_EQ(summary.batches, 1u);
  EXPECT_EQ(summary.motions, 19u);
}
