#include "ros/queries/service_statistics.hpp"

#include <gtest/gtest.h>

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
