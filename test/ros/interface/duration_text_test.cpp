#include "ros/interface/duration_text.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

TEST(DurationText, HasThreeDigits) {
  EXPECT_EQ(duration_text(0.0), "0 ms");
  EXPECT_EQ(duration_text(0.0073), "7.3 ms");
  EXPECT_EQ(duration_text(0.020004), "20 ms");
  EXPECT_EQ(duration_text(0.25), "250 ms");
  EXPECT_EQ(duration_text(2.4123), "2.41 s");
}

TEST(DurationText, OfHoursHasAllDigitsBeforeThePoint) {
  EXPECT_EQ(duration_text(123456.7), "123457 s");
}
