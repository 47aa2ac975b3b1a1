#include "ros/interface/function_callback.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <vector>

using namespace organ_collision;

TEST(FunctionCallback, IsCalledOnceInItsTurnByTheThreadOfTheQueue) {
  ros::CallbackQueue queue;
  std::vector<int> called;
  for (const int number : {1, 2, 3}) {
    call_later(queue, [&called, number] { called.push_back(number); });
  }
  EXPECT_TRUE(called.empty());
  queue.callOne();
  EXPECT_EQ(called, std::vector<int>{1});
  queue.callAvailable();
  queue.callAvailable();
  EXPECT_EQ(called, (std::vector<int>{1, 2, 3}));
}
