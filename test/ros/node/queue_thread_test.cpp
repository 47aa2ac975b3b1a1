#include "ros/node/queue_thread.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <future>
#include <vector>

#include "ros/interface/function_callback.hpp"

using namespace organ_collision;

namespace {

/// The value of a function that is called in the background.
template <typename Function>
auto in_background(QueueThread& thread, Function function) {
  std::promise<decltype(function())> promise;
  auto value = promise.get_future();
  call_later(thread.queue(), [&] { promise.set_value(function()); });
  return value.get();
}

}  // namespace

TEST(QueueThread, CallsInItsOwnThread) {
  QueueThread thread;
  const std::thread::id first = in_background(thread, [] { return std::this_thread::get_id(); });
  const std::thread::id second = in_background(thread, [] { return std::this_thread::get_id(); });
  EXPECT_NE(first, std::this_thread::get_id());
  EXPECT_EQ(first, second);
}

TEST(QueueThread, YieldsToThisThread) {
  const auto niceness = [] { return getpriority(PRIO_PROCESS, 0); };
  const int here = niceness();
  QueueThread thread;
  EXPECT_GE(in_background(thread, niceness), std::min(here + 1, 19));
  EXPECT_EQ(niceness(), here);
}

TEST(QueueThread, YieldsToAThreadThatIsNiceItself) {
  const auto niceness = [] { return getpriority(PRIO_PROCESS, 0); };
  const int nicer = std::min(niceness() + 8, 18);
  int background = 0;
  std::thread([&] {  // Its niceness ends with it.
    setpriority(PRIO_PROCESS, 0, nicer);
    QueueThread thread;
    background = in_background(thread, niceness);
  })
      .join();
  EXPECT_EQ(background, std::min(nicer + 10, 19));
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
