#include "ros/motion/transform_buffer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hand_filled_transforms.hpp"

using namespace organ_collision;

namespace {

class TransformBufferTest : public testing::Test {
 protected:
  void send(const std::string& parent, const std::string& child, double time) {
    set_point(buffer_, parent, child, time, {0.1, 0.2, time});
  }
  void rest(const std::string& parent, const std::string& child) {
    set_point(buffer_, parent, child, 0.0, {0.1, 0.2, 0.3}, true);
  }
  /// The stamps of transforms between the liver and the frames, from 0 s to 100 s.
  std::vector<double> stamps(const TransformBuffer::Frames& frames) const {
    std::vector<double> seconds;
    for (const ros::Time stamp :
         buffer_.stamps_between("liver", frames, ros::Time(0.0), ros::Time(100.0))) {
      seconds.push_back(stamp.toSec());
    }
    return seconds;
  }

  TransformBuffer buffer_;
};

using Seconds = std::vector<double>;

}  // namespace

TEST_F(TransformBufferTest, IsTfsBuffer) {
  send("world", "tip", 1.0);
  send("world", "tip", 2.0);
  EXPECT_TRUE(buffer_.canTransform("world", "tip", ros::Time(1.5)));
  buffer_.clear();
  EXPECT_FALSE(buffer_.canTransform("world", "tip", ros::Time(1.5)));
}

TEST_F(TransformBufferTest, StampsOfAllFramesInBetweenRiseEachOnce) {
  rest("world", "liver");
  for (const double time : {1.0, 3.0, 4.0}) send("world", "arm", time);
  for (const double time : {2.0, 3.0, 5.5}) send("arm", "tip", time);
  send("arm", "other_arm", 4.5);
  EXPECT_EQ(stamps({"tip"}), (Seconds{1.0, 2.0, 3.0, 4.0, 5.5}));
  EXPECT_EQ(stamps({"arm"}), (Seconds{1.0, 3.0, 4.0}));
  EXPECT_EQ(stamps({"arm", "tip", "arm"}), (Seconds{1.0, 2.0, 3.0, 4.0, 5.5}));
  EXPECT_EQ(buffer_.stamps_between("liver", {"tip"}, ros::Time(2.0), ros::Time(5.5)),
            (std::vector<ros::Time>{ros::Time(3.0), ros::Time(4.0)}));
  EXPECT_TRUE(buffer_.stamps_between("liver", {"tip"}, ros::Time(5.0), ros::Time(2.0)).empty());
  EXPECT_TRUE(stamps({"nowhere"}).empty());
}

TEST_F(TransformBufferTest, TheOrgansFramesCountAsWell) {
  rest("world", "tip");
  send("world", "body", 1.0);
  send("body", "liver", 2.0);
  EXPECT_EQ(stamps({"tip"}), (Seconds{1.0, 2.0}));
}

TEST_F(TransformBufferTest, WhatIsAboveBothDoesNotCount) {
  send("world", "table", 1.0);
  send("table", "liver", 2.0);
  send("table", "arm", 3.0);
  send("arm", "tip", 4.0);
  EXPECT_EQ(stamps({"tip"}), (Seconds{2.0, 3.0, 4.0}));
}

TEST_F(TransformBufferTest, EveryParentThatAFrameHadCounts) {
  send("world", "liver", 1.0);
  send("world", "left", 2.0);
  send("world", "right", 3.0);
  send("left", "needle", 4.0);
  send("right", "needle", 5.0);
  send("liver", "needle", 6.0);
  EXPECT_EQ(stamps({"needle"}), (Seconds{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
}

TEST_F(TransformBufferTest, LoopsAndCrowdsOfParentsEnd) {
  send("a", "b", 1.0);
  send("b", "a", 2.0);
  EXPECT_EQ(stamps({"a"}), (Seconds{1.0, 2.0}));
  for (int i = 1; i <= 50; ++i) {
    send("world", "hand_" + std::to_string(i), 10.0 + i);
    send("hand_" + std::to_string(i), "needle", 10.0 + i);
  }
  EXPECT_EQ(stamps({"needle"}).back(), 60.0);
}

TEST_F(TransformBufferTest, WhatTfRefusesIsNotInTheRecord) {
  send("world", "tip", 20.0);
  send("world", "tip", 21.0);
  send("world", "tip", 5.0);  // Too old to be kept.
  set_point(buffer_, "world", "tip", 22.0, {0.1, std::nan(""), 0.3});
  EXPECT_EQ(stamps({"tip"}), (Seconds{20.0, 21.0}));
  EXPECT_TRUE(buffer_.has_heard("tip"));
  EXPECT_FALSE(buffer_.has_heard("world"));
  buffer_.clear();
  EXPECT_FALSE(buffer_.has_heard("tip"));
}

TEST_F(TransformBufferTest, CountsWhatComesAfterItsStep) {
  rest("world", "liver");
  send("world", "arm", 1.0);
  send("arm", "tip", 1.0);
  send("arm", "tip", 3.0);
  send("world", "arm", 3.0);
  buffer_.set_answered("liver", {"tip"}, ros::Time(2.0));
  send("arm", "tip", 1.0);  // The same transform again.
  send("arm", "tip", 2.5);
  send("world", "somewhere", 1.5);
  EXPECT_EQ(buffer_.late(), 0u);
  send("world", "arm", 1.5);
  EXPECT_EQ(buffer_.late(), 1u);
  buffer_.set_answered("liver", {"tip"}, ros::Time(1.0));
  send("arm", "tip", 2.0);
  EXPECT_EQ(buffer_.late(), 2u);
  send("arm", "tip", 2.0);
  EXPECT_EQ(buffer_.late(), 2u);
}

TEST_F(TransformBufferTest, NothingIsLateAfterAJumpOfTheClock) {
  send("world", "tip", 5.0);
  buffer_.set_answered("world", {"tip"}, ros::Time(5.0));
  buffer_.clear();
  send("world", "tip", 1.0);
  EXPECT_EQ(buffer_.late(), 0u);
}
