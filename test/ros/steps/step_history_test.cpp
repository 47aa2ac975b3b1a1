#include "ros/steps/step_history.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

namespace {

ShapeQueue::Entry entry(int second) {
  return {{nullptr, ros::Time(second), ros::Time(second)},
          SteadyTime(std::chrono::seconds(second))};
}

LastStep step(int second) {
  return {{{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}}, ros::Time(second), nullptr};
}

int front(const ShapeQueue& queue) {
  return queue.front() ? static_cast<int>(queue.front()->shape.stamp.sec) : -1;
}

}  // namespace

TEST(ShapeQueue, NewestReplacesTheOnesBehindTheFirst) {
  ShapeQueue queue;
  EXPECT_EQ(front(queue), -1);
  for (int i = 1; i < 5; ++i) queue.push(entry(i));
  EXPECT_EQ(front(queue), 1);
  queue.pop();
  EXPECT_EQ(front(queue), 4);
  EXPECT_EQ(queue.front()->arrival, SteadyTime(std::chrono::seconds(4)));
  queue.pop();
  EXPECT_EQ(front(queue), -1);
  queue.push(entry(7));
  EXPECT_EQ(front(queue), 7);
}

TEST(ShapeQueue, TellsWhetherAShapeWasReplaced) {
  ShapeQueue queue;
  std::vector<bool> replaced;
  for (int i = 1; i < 5; ++i) replaced.push_back(queue.push(entry(i)));
  EXPECT_EQ(replaced, (std::vector<bool>{false, false, true, true}));
}

TEST(ShapeQueue, KeepsAllIfToldSo) {
  ShapeQueue queue;
  for (int i = 1; i < 5; ++i) EXPECT_FALSE(queue.push(entry(i), true));
  for (int i = 1; i < 5; ++i, queue.pop()) EXPECT_EQ(front(queue), i);
  EXPECT_EQ(front(queue), -1);
}

TEST(ShapeQueue, PopsNothingFromNothing) {
  ShapeQueue queue;
  queue.pop();
  EXPECT_EQ(front(queue), -1);
}

TEST(StepHistory, EachPairHasItsOwn) {
  StepHistory history;
  history.of("liver", 0).last = step(1);
  history.of("liver", 1).last = step(2);
  history.of("kidney", 0).last = step(3);
  EXPECT_EQ(history.last("liver", 0)->stamp, ros::Time(1));
  EXPECT_EQ(history.last("liver", 1)->stamp, ros::Time(2));
  EXPECT_EQ(history.last("kidney", 0)->stamp, ros::Time(3));
  EXPECT_EQ(history.last("kidney", 1), nullptr);
}

TEST(StepHistory, PairWithoutStepHasNoLast) {
  StepHistory history;
  history.of("liver", 0).queue.push(entry(1));
  EXPECT_EQ(history.last("liver", 0), nullptr);
}

TEST(StepHistory, ForgetsOneOrganOrAll) {
  StepHistory history;
  for (const char* organ : {"kidney", "liver", "liver2", "spleen"}) {
    for (std::size_t tool = 0; tool < 3; ++tool) history.of(organ, tool).last = step(1);
  }
  history.forget("liver");
  EXPECT_EQ(history.pairs().size(), 9u);
  EXPECT_EQ(history.last("liver", 2), nullptr);
  EXPECT_NE(history.last("liver2", 0), nullptr);
  EXPECT_NE(history.last("kidney", 2), nullptr);
  history.forget("stomach");
  EXPECT_EQ(history.pairs().size(), 9u);
  history.clear();
  EXPECT_TRUE(history.pairs().empty());
}

TEST(StepHistory, KeptToolsAreNumberedAnewAndOthersForgotten) {
  StepHistory history;
  for (const char* organ : {"kidney", "liver"}) {
    for (int tool = 0; tool < 3; ++tool) history.of(organ, tool).last = step(10 + tool);
  }
  history.renumber({std::nullopt, 2, 0, std::nullopt});
  EXPECT_EQ(history.pairs().size(), 4u);
  for (const char* organ : {"kidney", "liver"}) {
    EXPECT_EQ(history.last(organ, 0), nullptr);
    EXPECT_EQ(history.last(organ, 1)->stamp, ros::Time(12));
    EXPECT_EQ(history.last(organ, 2)->stamp, ros::Time(10));
    EXPECT_EQ(history.last(organ, 3), nullptr);
  }
}
