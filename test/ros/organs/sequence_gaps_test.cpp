#include "ros/organs/sequence_gaps.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

TEST(SequenceGapsTest, CountsWhatIsMissingBetweenTwoMessages) {
  SequenceGaps gaps;
  EXPECT_EQ(gaps.add("/simulator", 7), 0U) << "what came before the first one was not meant for us";
  EXPECT_EQ(gaps.add("/simulator", 8), 0U);
  EXPECT_EQ(gaps.add("/simulator", 12), 3U);
}

TEST(SequenceGapsTest, EachPublisherHasItsOwnNumbers) {
  SequenceGaps gaps;
  gaps.add("/left", 1);
  EXPECT_EQ(gaps.add("/right", 40), 0U);
  EXPECT_EQ(gaps.add("/left", 2), 0U);
  EXPECT_EQ(gaps.add("/right", 42), 1U);
}

TEST(SequenceGapsTest, AStartAgainAndAMessageWithoutANumberAreNoGap) {
  SequenceGaps gaps;
  gaps.add("/simulator", 1000);
  EXPECT_EQ(gaps.add("/simulator", 0), 0U);
  EXPECT_EQ(gaps.add("/simulator", 0), 0U) << "within a process, messages have no number";
  EXPECT_EQ(gaps.add("/simulator", 1), 0U);
}

TEST(SequenceGapsTest, ManyPublishersDoNotFillTheMemory) {
  SequenceGaps gaps;
  for (int i = 0; i <= 1000; ++i) gaps.add("/rostopic_" + std::to_string(i), 5);
  EXPECT_EQ(gaps.add("/rostopic_0", 9), 0U) << "forgotten";
  EXPECT_EQ(gaps.add("/rostopic_1000", 9), 3U) << "the newest one is known";
}
