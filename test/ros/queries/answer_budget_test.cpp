#include "ros/queries/answer_budget.hpp"

#include <gtest/gtest.h>

#include <future>
#include <mutex>
#include <vector>

using namespace organ_collision;

namespace {

/// The result of wait() in another thread.
std::future<bool> waits(AnswerBudget& budget, std::size_t block) {
  return std::async(std::launch::async, [&budget, block] { return budget.wait(block, 0); });
}

bool is_waiting(std::future<bool>& result) {
  return result.wait_for(std::chrono::milliseconds(20)) == std::future_status::timeout;
}

}  // namespace

TEST(AnswerBudget, WithinTheBoundNobodyWaits) {
  AnswerBudget budget(100);
  budget.add(60);
  budget.add(40);
  for (std::size_t block = 0; block < 5; ++block) EXPECT_TRUE(budget.wait(block, 0));
}

TEST(AnswerBudget, AboveTheBoundBlocksGoOnInTheirOrder) {
  AnswerBudget budget(100);
  budget.add(101);
  EXPECT_TRUE(budget.wait(0, 0));
  std::future<bool> first = waits(budget, 1), second = waits(budget, 2);
  EXPECT_TRUE(is_waiting(first));
  budget.set_taken(0, 50);
  EXPECT_TRUE(first.get());
  EXPECT_TRUE(is_waiting(second));
  budget.set_taken(1, 60);
  EXPECT_TRUE(second.get());
}

TEST(AnswerBudget, ABlockStopsIfTheBatchExceedsTheBoundWithIt) {
  AnswerBudget budget(100);
  budget.add(90);
  budget.set_taken(0, 80);
  EXPECT_TRUE(budget.wait(1, 21));  // All answers so far are within the bound.
  budget.add(20);
  EXPECT_TRUE(budget.wait(1, 20));
  EXPECT_FALSE(budget.wait(1, 21));
}

TEST(AnswerBudget, TheEndEndsAllWaits) {
  AnswerBudget budget(0);
  budget.add(1);
  std::future<bool> waiting = waits(budget, 3);
  EXPECT_TRUE(is_waiting(waiting));
  budget.end();
  EXPECT_FALSE(waiting.get());
  EXPECT_FALSE(budget.wait(0, 0));
}
