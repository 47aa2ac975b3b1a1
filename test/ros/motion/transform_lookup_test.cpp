#include "ros/motion/transform_lookup.hpp"

#include <gtest/gtest.h>

#include "hand_filled_transforms.hpp"
#include "ros/interface/plain_text.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

Isometry3d pose(double x, double angle) {
  return Eigen::Translation3d(x, -0.2, 0.7) *
         Eigen::AngleAxisd(angle, Vector3d(0.3, -1.0, 0.4).normalized());
}

std::string why_not(const TransformBuffer& buffer, const std::string& target,
                    const std::string& source, double time) {
  const auto lookup = look_up(buffer, target, source, ros::Time(time));
  EXPECT_FALSE(lookup.found);
  return lookup.why_not;
}

}  // namespace

TEST(LookUp, FollowsTheChain) {
  TransformBuffer buffer;
  set_transform(buffer, "world", "liver", 3.0, pose(0.1, 0.5));
  set_transform(buffer, "world", "tip", 3.0, pose(0.4, -1.1));
  const auto found = look_up(buffer, "liver", "tip", ros::Time(3.0)).found;
  ASSERT_TRUE(found);
  const Isometry3d expected = pose(0.1, 0.5).inverse() * pose(0.4, -1.1);
  EXPECT_TRUE(found->value.isApprox(expected, 1e-9));
  EXPECT_EQ(found->stamp, ros::Time(3.0));
}

TEST(LookUp, LatestSaysItsTime) {
  TransformBuffer buffer;
  for (const double time : {3.0, 3.5}) set_transform(buffer, "a", "b", time, pose(time, 0.2));
  const auto found = look_up(buffer, "a", "b", ros::Time(0)).found;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->stamp, ros::Time(3.5));
  EXPECT_NEAR(found->value.translation().x(), 3.5, 1e-12);
}

TEST(LookUp, RestingTransformsAreOfAnyTime) {
  TransformBuffer buffer;
  set_transform(buffer, "a", "b", 3.0, pose(0.1, 0.2), true);
  EXPECT_TRUE(look_up(buffer, "a", "b", ros::Time(0)).found->stamp.isZero());
  EXPECT_EQ(look_up(buffer, "a", "b", ros::Time(99)).found->stamp, ros::Time(99));
}

TEST(LookUp, AFrameInItselfNeedsNoTransform) {
  const auto found = look_up(TransformBuffer(), "liver", "liver", ros::Time(4)).found;
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->value.isApprox(Isometry3d::Identity()));
}

TEST(LookUp, NothingWithoutTransformAndSaysWhy) {
  TransformBuffer buffer;
  set_transform(buffer, "world", "liver", 3.0, pose(0.1, 0.5));
  set_transform(buffer, "elsewhere", "tip", 3.0, pose(0.1, 0.5));
  for (const char* frame : {"never_heard_of", "", "/world"}) {
    const std::string unknown = "frame '" + std::string(frame) + "' is unknown to TF";
    EXPECT_EQ(why_not(buffer, "liver", frame, 3.0), unknown);
    EXPECT_EQ(why_not(buffer, frame, "liver", 3.0), unknown);
  }
  EXPECT_EQ(why_not(buffer, "liver", "tip", 3.0), "frame 'tip' is not connected to 'liver' on TF");
}

TEST(LookUp, SaysHowLateTransformsAre) {
  TransformBuffer buffer;
  for (const double time : {3.0, 3.5}) set_transform(buffer, "a", "b", time, pose(time, 0.2));
  for (const double time : {3.0, 3.6}) set_transform(buffer, "b", "c", time, pose(time, 0.1));
  EXPECT_EQ(why_not(buffer, "a", "c", 3.5073),
            "TF from 'c' to 'a' is 7.3 ms behind the stamp 3.507300000");
  EXPECT_EQ(why_not(buffer, "a", "c", 99.0),
            "TF from 'c' to 'a' is 95.5 s behind the stamp 99.000000000");
  EXPECT_TRUE(look_up(buffer, "a", "c", ros::Time(3.6)).is_late);
  const auto early = look_up(buffer, "a", "c", ros::Time(2.9));
  EXPECT_FALSE(early.found);
  EXPECT_FALSE(early.is_late) << early.why_not;
  EXPECT_NE(early.why_not.find("past"), std::string::npos) << early.why_not;
}

TEST(LookUp, ALoopAmongManyFramesIsToldInAShortMessage) {
  TransformBuffer buffer;
  set_transform(buffer, "world", "liver", 3.0, pose(0.1, 0.5));
  set_transform(buffer, "a", "b", 3.0, pose(0.1, 0.5));
  set_transform(buffer, "b", "a", 3.0, pose(0.1, 0.5));
  for (int i = 0; i < 1000; ++i) {
    set_transform(buffer, "b", std::string(1000, 'x') + std::to_string(i), 3.0, pose(0.1, 0.5));
  }
  const auto lookup = look_up(buffer, "liver", "a", ros::Time(3.0));
  EXPECT_FALSE(lookup.found);
  EXPECT_LE(lookup.why_not.size(), 2 * kLongestMessage);
  EXPECT_NE(lookup.why_not.find("from a to liver"), std::string::npos) << lookup.why_not;
}

TEST(LookUp, NothingOutsideTheKnownTimes) {
  TransformBuffer buffer;
  for (const double time : {3.0, 3.5}) set_transform(buffer, "a", "b", time, pose(time, 0.2));
  EXPECT_FALSE(look_up(buffer, "a", "b", ros::Time(2.9)).found);
  EXPECT_FALSE(look_up(buffer, "a", "b", ros::Time(3.6)).found);
  EXPECT_TRUE(look_up(buffer, "a", "b", ros::Time(3.2)).found);
}

TEST(HasTransform, AgreesWithLookUp) {
  TransformBuffer buffer;
  for (const double time : {3.0, 3.5})
    set_transform(buffer, "world", "liver", time, pose(0.1, 0.5));
  set_transform(buffer, "world", "trocar", 0.0, pose(0.4, -1.1), true);
  set_transform(buffer, "elsewhere", "tip", 3.0, pose(0.1, 0.5));
  for (const char* source : {"trocar", "tip", "liver", "never_heard_of"}) {
    for (const double time : {0.0, 2.9, 3.0, 3.2, 3.5, 3.6, 4294967295.0}) {
      const bool found = look_up(buffer, "liver", source, ros::Time(time)).found.has_value();
      EXPECT_EQ(has_transform(buffer, "liver", source, ros::Time(time)), found)
          << source << " at " << time;
    }
  }
}

TEST(OldestTransform, IsThatOfAFrameBelowTheFirstThatCarriesBoth) {
  TransformBuffer buffer;
  const auto send = [&](const std::string& parent, const std::string& child, double time,
                        bool resting = false) {
    set_transform(buffer, parent, child, time, pose(0.1, 0.2), resting);
  };
  send("world", "room", 1.0);
  send("room", "table", 7.0);
  send("table", "patient", 3.0);
  send("table", "patient", 6.0);
  send("patient", "liver", 0.0, true);
  send("room", "arm", 2.0);
  send("patient", "trocar", 0.0, true);
  const auto oldest = [&](const std::string& frame, const std::vector<std::string>& others) {
    const auto found = oldest_transform(buffer, frame, others);
    return found ? found->frame + std::to_string(static_cast<int>(found->stamp.toSec())) : "none";
  };
  EXPECT_EQ(oldest("liver", {"arm"}), "patient6");
  EXPECT_EQ(oldest("arm", {"liver"}), "arm2");
  EXPECT_EQ(oldest("liver", {"trocar"}), "none");
  EXPECT_EQ(oldest("liver", {"trocar", "arm"}), "patient6");
  EXPECT_EQ(oldest("room", {"liver"}), "none");
  EXPECT_EQ(oldest("liver", {"world"}), "room1");
  EXPECT_EQ(oldest("liver", {"liver"}), "none");
  EXPECT_EQ(oldest("liver", {"nowhere"}), "room1");
  EXPECT_EQ(oldest("nowhere", {"liver"}), "none");
}
