#include "organ_collision/ros/rejection.hpp"

#include <gtest/gtest.h>

TEST(Rejection, KeepsWhatItWasMadeOf) {
  const organ_collision::Rejection rejection(4, "wrong size", "7 numbers; must be a multiple of 3");
  EXPECT_EQ(rejection.status(), 4);
  EXPECT_EQ(rejection.reason(), "wrong size");
  EXPECT_STREQ(rejection.what(), "7 numbers; must be a multiple of 3");
}
