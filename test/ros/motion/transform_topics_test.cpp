#include "ros/motion/transform_topics.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace organ_collision;

namespace {

geometry_msgs::TransformStamped transform(const std::string& child, double time) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "/world";
  transform.header.stamp = ros::Time(time);
  transform.child_frame_id = child;
  transform.transform.translation.x = time;
  transform.transform.rotation.w = 1.0;
  return transform;
}

class TransformTopicsTest : public testing::Test {
 protected:
  TransformTopicsTest() { ros::Time::init(); }

  void take(const std::vector<geometry_msgs::TransformStamped>& transforms, bool resting) {
    tf2_msgs::TFMessage message;
    message.transforms = transforms;
    topics_.take(message, "robot", resting);
  }

  TransformBuffer buffer_;
  FailureLog rejected_;
  TransformTopics topics_{buffer_, rejected_};
};

}  // namespace

TEST_F(TransformTopicsTest, TransformsGoToTheBufferWithTheirStamps) {
  take({transform("tip", 1.0), transform("tip", 1.0005), transform("tip", 2.0)}, false);
  take({transform("trocar", 1.0)}, true);
  EXPECT_TRUE(buffer_.canTransform("trocar", "tip", ros::Time(1.5)));
  EXPECT_EQ(buffer_.stamps_between("trocar", {"tip"}, ros::Time(0.5), ros::Time(3.0)),
            (std::vector<ros::Time>{ros::Time(1.0), ros::Time(1.0005), ros::Time(2.0)}));
}

TEST_F(TransformTopicsTest, WhatTfRefusesIsCountedButNoRepetition) {
  geometry_msgs::TransformStamped broken = transform("tip", 1.0);
  broken.transform.translation.y = std::nan("");
  take({broken, transform("tip", 1.0), transform("tip", 1.0)}, false);
  EXPECT_EQ(rejected_.by_reason()["transform"].count, 1u);
  EXPECT_NE(rejected_.by_reason()["transform"].latest.find("(1, nan, 0)"), std::string::npos)
      << rejected_.by_reason()["transform"].latest;
  take({transform("tip", 100.0), transform("tip", 1.5)}, false);
  EXPECT_EQ(rejected_.by_reason()["transform"].count, 2u) << "1.5 is too old";
  take({broken}, true);
  EXPECT_EQ(rejected_.by_reason()["transform"].count, 3u);
}

TEST_F(TransformTopicsTest, WhatTfThrowsAtIsCountedAndTheOthersStay) {
  geometry_msgs::TransformStamped absurd = transform("tip", 1.0);
  absurd.header.stamp = ros::Time(4294967295u, 999999999u);
  take({transform("tip", 1.0), absurd, transform("trocar", 1.0)}, false);
  EXPECT_TRUE(buffer_.canTransform("world", "trocar", ros::Time(1.0)));
  ASSERT_EQ(rejected_.by_reason().count("transform"), 1u);
  const FailureLog::Entry rejected = rejected_.by_reason().at("transform");
  EXPECT_EQ(rejected.count, 1u);
  EXPECT_NE(rejected.latest.find("'tip'"), std::string::npos) << rejected.latest;
}
