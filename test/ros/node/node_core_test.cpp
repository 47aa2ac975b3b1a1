#include "ros/node/node_core.hpp"

#include <gtest/gtest.h>
#include <ros/time.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <stdexcept>
#include <vector>

#include "ros/node/queues.hpp"

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

namespace organ_collision {
namespace {

using namespace std::chrono_literals;

class MessageLoopTest : public testing::Test {
 protected:
  MessageLoopTest() { ros::Time::init(); }

  FailureLog rejected_;
  int watched_ = 0, handled_ = 0;
  MessageLoop loop_{rejected_, {[this] { ++watched_; }, [this](SteadyTime) { ++handled_; }}};
};

TEST_F(MessageLoopTest, CallsAllCallbacksThatAreThere) {
  int called = 0;
  for (int i = 0; i < 5; ++i) call_later(loop_.queue(), [&] { ++called; });
  while (called < 5) loop_.receive(std::nullopt);
  EXPECT_GE(handled_, 5) << "after each callback";
  EXPECT_GE(watched_, handled_) << "before each callback, and after a batch";
}

TEST_F(MessageLoopTest, ReturnsWithoutACallback) {
  loop_.receive(std::nullopt);
  loop_.receive(loop_.now());
  loop_.receive(loop_.now() - 1s);
  EXPECT_EQ(handled_, 3);
}

TEST_F(MessageLoopTest, HearsUntilTheQueueIsEmpty) {
  const SteadyTime before = loop_.now();
  loop_.receive(loop_.now());
  EXPECT_GE(loop_.heard_until(), before);
  EXPECT_LE(loop_.heard_until(), loop_.now());
}

TEST_F(MessageLoopTest, CountsWhatIsThrown) {
  loop_.guard([] { throw std::runtime_error("broken"); });
  ASSERT_EQ(rejected_.by_reason().count("exception"), 1u);
  EXPECT_EQ(rejected_.by_reason().at("exception").count, 1u);
}

TEST_F(MessageLoopTest, DropsCallbacksAtItsEnd) {
  bool called = false;
  call_later(loop_.queue(), [&] { called = true; });
  loop_.end();
  call_later(loop_.queue(), [&] { called = true; });
  loop_.receive(loop_.now());
  EXPECT_FALSE(called);
}

}  // namespace

}  // namespace organ_collision
