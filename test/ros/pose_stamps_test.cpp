#include "organ_collision/ros/pose_stamps.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

TEST(PoseStamps, RiseInWhateverOrderTheyCome) {
  PoseStamps stamps;
  for (const double time : {3.0, 1.0, 2.0, 5.0, 4.0}) stamps.add(ros::Time(time));
  const std::vector<ros::Time> between = {ros::Time(2.0), ros::Time(3.0), ros::Time(4.0)};
  EXPECT_EQ(stamps.between(ros::Time(1.0), ros::Time(5.0)), between);
  EXPECT_TRUE(stamps.between(ros::Time(5.0), ros::Time(9.0)).empty());
  EXPECT_TRUE(stamps.between(ros::Time(4.0), ros::Time(2.0)).empty());
}

TEST(PoseStamps, OnlyTheLatestAreKept) {
  PoseStamps stamps;
  for (int i = 0; i < 20'000; ++i) stamps.add(ros::Time(1.0 + 0.001 * i));
  const std::vector<ros::Time> kept = stamps.between(ros::Time(0.5), ros::Time(100.0));
  EXPECT_EQ(kept.size(), 10'000u);
  EXPECT_EQ(kept.back(), ros::Time(1.0 + 0.001 * 19'999));
}
