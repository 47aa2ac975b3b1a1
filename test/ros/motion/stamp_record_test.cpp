#include "ros/motion/stamp_record.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

namespace {

constexpr double kKept = 10.0;  // [s]

std::vector<ros::Time> between(const StampRecord& record, double from, double to) {
  std::vector<ros::Time> stamps;
  record.append_between(ros::Time(from), ros::Time(to), stamps);
  return stamps;
}

}  // namespace

TEST(StampRecord, RiseInWhateverOrderTheyCome) {
  StampRecord record{ros::Duration(kKept)};
  for (const double time : {3.0, 1.0, 2.0, 5.0, 4.0}) record.add(ros::Time(time));
  const std::vector<ros::Time> expected = {ros::Time(2.0), ros::Time(3.0), ros::Time(4.0)};
  EXPECT_EQ(between(record, 1.0, 5.0), expected);
  EXPECT_TRUE(between(record, 5.0, 9.0).empty());
  EXPECT_TRUE(between(record, 4.0, 2.0).empty());
  EXPECT_TRUE(record.contains(ros::Time(3.0)));
  EXPECT_FALSE(record.contains(ros::Time(3.5)));
}

TEST(StampRecord, WhatTfForgetsIsForgotten) {
  StampRecord record{ros::Duration(kKept)};
  for (const double time : {1.0, 5.0, 11.0, 11.5}) record.add(ros::Time(time));
  const std::vector<ros::Time> expected = {ros::Time(5.0), ros::Time(11.0), ros::Time(11.5)};
  EXPECT_EQ(between(record, 0.5, 100.0), expected);
  record.clear();
  EXPECT_TRUE(record.empty());
}

TEST(StampRecord, OnlyTheLatestOfTooManyAreKept) {
  StampRecord record{ros::Duration(kKept)};
  constexpr std::size_t kMost = StampRecord::kMost;
  for (std::size_t i = 0; i < 2 * kMost; ++i) record.add(ros::Time(1.0 + 1e-4 * double(i)));
  const std::vector<ros::Time> kept = between(record, 0.5, 100.0);
  EXPECT_EQ(kept.size(), kMost);
  EXPECT_EQ(kept.back(), ros::Time(1.0 + 1e-4 * double(2 * kMost - 1)));
}
