#include "ros/publishing/event_rate.hpp"

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
