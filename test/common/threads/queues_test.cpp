#include "common/threads/queues.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <stdexcept>
#include <vector>

namespace organ_collision {
namespace {

TEST(RunInThreadOf, AQueueThatIsDisabledOrClearedEndsTheWait) {
  ros::CallbackQueue queue;
  bool has_run = false;
  std::thread waiting(
      [&] { EXPECT_THROW(run_in_thread_of(queue, [&] { has_run = true; }), std::runtime_error); });
  while (queue.isEmpty()) std::this_thread::yield();
  queue.disable();
  queue.clear();
  waiting.join();
  EXPECT_FALSE(has_run);
  EXPECT_THROW(run_in_thread_of(queue, [] {}), std::runtime_error);
}

TEST(QueueThread, EndsWithItsPresentCallback) {
  std::vector<int> called;
  std::promise<void> started, finish;
  {
    QueueThread thread;
    call_later(thread.queue(), [&] {
      started.set_value();
      finish.get_future().wait();
      called.push_back(1);
    });
    started.get_future().wait();
    finish.set_value();
  }
  EXPECT_EQ(called, std::vector<int>{1});
}

}  // namespace
}  // namespace organ_collision
