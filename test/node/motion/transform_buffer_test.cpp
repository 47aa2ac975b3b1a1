#include "node/motion/transform_buffer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/messages/text.hpp"
#include "tool_poses_fixture.hpp"

using namespace organ_collision;

namespace {

class TransformBufferTest : public testing::Test {
 protected:
  TransformBufferTest() { ros::Time::setNow(ros::Time(1000.0)); }

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
         buffer_.stamps_between("liver", frames, ros::Time(0.0), ros::Time(100.0)).rising) {
      seconds.push_back(stamp.toSec());
    }
    return seconds;
  }

  TransformBuffer buffer_;
};

using Seconds = std::vector<double>;

}  // namespace

TEST_F(TransformBufferTest, StampsOfAllFramesInBetweenRiseEachOnce) {
  rest("world", "liver");
  for (const double time : {1.0, 3.0, 4.0}) send("world", "arm", time);
  for (const double time : {2.0, 3.0, 5.5}) send("arm", "tip", time);
  send("arm", "other_arm", 4.5);
  EXPECT_EQ(stamps({"tip"}), (Seconds{1.0, 2.0, 3.0, 4.0, 5.5}));
  EXPECT_EQ(stamps({"arm"}), (Seconds{1.0, 3.0, 4.0}));
  EXPECT_EQ(stamps({"arm", "tip", "arm"}), (Seconds{1.0, 2.0, 3.0, 4.0, 5.5}));
  EXPECT_EQ(buffer_.stamps_between("liver", {"tip"}, ros::Time(2.0), ros::Time(5.5)).rising,
            (std::vector<ros::Time>{ros::Time(3.0), ros::Time(4.0)}));
  EXPECT_TRUE(
      buffer_.stamps_between("liver", {"tip"}, ros::Time(5.0), ros::Time(2.0)).rising.empty());
  EXPECT_TRUE(stamps({"nowhere"}).empty());
}

TEST_F(TransformBufferTest, EveryParentThatAFrameHadCountsUnlessItIsAboveBoth) {
  send("world", "table", 1.0);
  send("table", "liver", 2.0);
  send("table", "left", 3.0);
  send("left", "needle", 4.0);
  EXPECT_EQ(stamps({"needle"}), (Seconds{2.0, 3.0, 4.0}));
  send("world", "right", 5.0);
  send("right", "needle", 6.0);
  send("liver", "needle", 7.0);
  EXPECT_EQ(stamps({"needle"}), (Seconds{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}));
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

TEST_F(TransformBufferTest, TimesThatAreFarApartAreNoError) {
  send("world", "tip", 20.0);
  for (const double time : {30.0, 2147483647.0, 2147483648.0, 4294967000.0, 4294967295.0}) {
    const auto found = look_up(buffer_, "world", "tip", ros::Time(time));
    EXPECT_TRUE(found.is_late) << found.why_not;
    EXPECT_NE(found.why_not.find("behind the stamp"), std::string::npos) << found.why_not;
  }
  for (const double time : {2147483648.0, 4294967000.0}) {
    send("world", "tip", time);
    EXPECT_TRUE(buffer_.has("tip", ros::Time(time)));
    EXPECT_TRUE(look_up(buffer_, "world", "tip", ros::Time(time)).found);
    EXPECT_FALSE(look_up(buffer_, "world", "tip", ros::Time(20.0)).found);
  }
}

TEST_F(TransformBufferTest, ForgetsWhatTfForgetsAndTheOldestOfTooMany) {
  const auto found = [&] {
    return buffer_.stamps_between("liver", {"tip"}, ros::Time(0.5), ros::Time(100.0));
  };
  for (const double time : {1.0, 5.0, 4.0, 11.5}) send("liver", "tip", time);
  EXPECT_EQ(stamps({"tip"}), (Seconds{4.0, 5.0, 11.5}));
  EXPECT_EQ(found().forgotten, ros::Time(1.0));
  for (int i = 0; i < 10'001; ++i) send("liver", "tip", 12.0 + 1e-4 * i);
  EXPECT_EQ(found().rising.size(), 10'000U);
  EXPECT_EQ(found().forgotten, ros::Time(12.0));
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
  EXPECT_EQ(buffer_.late_frame("liver", {"tip"}, 0), "");
  send("world", "arm", 1.5);
  EXPECT_EQ(buffer_.late(), 1u);
  EXPECT_EQ(buffer_.late_frame("liver", {"tip"}, 0), "arm");
  EXPECT_EQ(buffer_.late_frame("liver", {"tip"}, 1), "");
  EXPECT_EQ(buffer_.late_frame("liver", {"somewhere"}, 0), "");
  buffer_.set_answered("liver", {"tip"}, ros::Time(1.0));
  send("arm", "tip", 2.0);
  EXPECT_EQ(buffer_.late(), 2u);
  send("arm", "tip", 2.0);
  EXPECT_EQ(buffer_.late(), 2u);
  buffer_.clear();  // As after a jump of the clock.
  send("arm", "tip", 1.0);
  EXPECT_EQ(buffer_.late(), 2u);
}

TEST_F(TransformBufferTest, WhatIsNotFoundHasAReason) {
  rest("elsewhere", "hand");
  for (const double time : {3.0, 3.5}) send("world", "liver", time);
  for (const double time : {3.0, 3.6}) send("world", "tip", time);
  struct Case {
    const char *target, *source;
    double time;
    std::string why_not;
    bool is_late = false;
  };
  for (const Case& row :
       {Case{"liver", "nobody", 3.0, "frame 'nobody' is unknown to TF"},
        Case{"nobody", "liver", 3.0, "frame 'nobody' is unknown to TF"},
        Case{"liver", "", 3.0, "frame '' is unknown to TF"},
        Case{"liver", "/world", 3.0, "frame '/world' is unknown to TF"},
        Case{"liver", "hand", 3.0, "frame 'hand' is not connected to 'liver' on TF"},
        Case{"liver", "tip", 3.5073,
             "TF from 'tip' to 'liver' is 7.3 ms behind the stamp 3.507300000", true},
        Case{"liver", "tip", 99.0,
             "TF from 'tip' to 'liver' is 95.5 s behind the stamp 99.000000000", true},
        Case{"liver", "tip", 2.9, "past"}, Case{"liver", "tip", 4294967295.0, ""}}) {
    const auto lookup = look_up(buffer_, row.target, row.source, ros::Time(row.time));
    EXPECT_FALSE(lookup.found);
    EXPECT_FALSE(lookup.why_not.empty());
    EXPECT_NE(lookup.why_not.find(row.why_not), std::string::npos) << lookup.why_not;
    if (row.time < 100.0) {
      EXPECT_EQ(lookup.is_late, row.is_late) << lookup.why_not;
    }
  }
}

TEST_F(TransformBufferTest, ALoopAmongManyFramesIsToldInAShortMessage) {
  rest("world", "liver");
  send("a", "b", 3.0);
  send("b", "a", 3.0);
  for (int i = 0; i < 1000; ++i) send("b", std::string(1000, 'x') + std::to_string(i), 3.0);
  const auto lookup = look_up(buffer_, "liver", "a", ros::Time(3.0));
  EXPECT_FALSE(lookup.found);
  EXPECT_LE(lookup.why_not.size(), 2 * kLongestMessage);
  EXPECT_NE(lookup.why_not.find("from a to liver"), std::string::npos) << lookup.why_not;
}

/// The clocks of the senders differ from the node's.
TEST_F(TransformBufferTest, TheOldestTransformIsBelowTheFirstFrameThatCarriesBoth) {
  const auto send_at = [this](double now, const char* parent, const char* child) {
    ros::Time::setNow(ros::Time(now));
    send(parent, child, 9.9 - now);
  };
  send_at(1.0, "world", "room");
  send_at(2.0, "room", "arm");
  send_at(3.0, "table", "patient");
  send_at(6.0, "table", "patient");
  send_at(7.0, "room", "table");
  rest("patient", "liver");
  rest("patient", "trocar");
  const auto oldest = [&](const std::string& frame, const std::vector<std::string>& others) {
    const auto found = buffer_.oldest_transform(frame, others);
    return found ? found->frame + std::to_string(found->received.sec) : "none";
  };
  const struct {
    const char* frame;
    std::vector<std::string> others;
    const char* oldest;
  } rows[] = {{"liver", {"arm"}, "patient6"}, {"arm", {"liver"}, "arm2"},
              {"liver", {"trocar"}, "none"},  {"liver", {"trocar", "arm"}, "patient6"},
              {"room", {"liver"}, "none"},    {"liver", {"world"}, "room1"},
              {"liver", {"liver"}, "none"},   {"liver", {"nowhere"}, "room1"},
              {"nowhere", {"liver"}, "none"}};
  for (const auto& row : rows) EXPECT_EQ(oldest(row.frame, row.others), row.oldest) << row.frame;
  send_at(8.0, "arm", "patient");  // It is handed over.
  EXPECT_EQ(oldest("liver", {"room"}), "arm2");
}
