#include "ros/node/queues.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <atomic>
#include <stdexcept>
#include <thread>
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

using namespace organ_collision;

namespace {

/// A thread that calls the callbacks of a queue, as a node's thread does.
class QueueThread {
 public:
  ~QueueThread() {
    stop_ = true;
    thread_.join();
  }
  ros::CallbackQueue& queue() { return queue_; }
  std::thread::id id() const { return thread_.get_id(); }

 private:
  ros::CallbackQueue queue_;
  std::atomic<bool> stop_{false};
  std::thread thread_{[this] {
    while (!stop_) queue_.callAvailable(ros::WallDuration(0.01));
  }};
};

}  // namespace

TEST(Handover, ActionsRunInTheOtherThreadAndAreWaitedFor) {
  QueueThread other;
  for (int i = 0; i < 100; ++i) {
    std::thread::id ran_in;
    run_in_thread_of(other.queue(), [&] { ran_in = std::this_thread::get_id(); });
    EXPECT_EQ(ran_in, other.id());
  }
}

TEST(Handover, ExceptionsComeBack) {
  QueueThread other;
  EXPECT_THROW(run_in_thread_of(other.queue(), [] { throw std::domain_error("no"); }),
               std::domain_error);
}

TEST(Handover, ADisabledQueueEndsTheWait) {
  ros::CallbackQueue queue;
  queue.disable();
  EXPECT_THROW(run_in_thread_of(queue, [] {}), std::runtime_error);
}

TEST(Handover, AClearedQueueEndsTheWait) {
  ros::CallbackQueue queue;
  bool has_run = false;
  std::thread waiting(
      [&] { EXPECT_THROW(run_in_thread_of(queue, [&] { has_run = true; }), std::runtime_error); });
  while (queue.isEmpty()) std::this_thread::yield();
  queue.disable();
  queue.clear();
  waiting.join();
  EXPECT_FALSE(has_run);
}
