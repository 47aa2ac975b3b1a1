#include "ros/publishing/markers/second_mean.hpp"

#include <gtest/gtest.h>

#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;

TEST(SecondMean, ChangesOnceASecond) {
  SecondMean mean;
  EXPECT_EQ(mean.at(at(0.0)), 0.0);
  mean.add(2.0);
  EXPECT_EQ(mean.at(at(0.1)), 2.0);
  mean.add(5.0);
  mean.add(9.0);
  EXPECT_EQ(mean.at(at(1.0)), 2.0);
  EXPECT_EQ(mean.at(at(1.2)), 7.0);
  EXPECT_EQ(mean.at(at(9.0)), 7.0);
}
