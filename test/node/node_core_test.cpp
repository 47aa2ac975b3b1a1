#include "node/node_core.hpp"

#include <gtest/gtest.h>
#include <ros/time.h>

#include <chrono>
#include <stdexcept>

namespace organ_collision {
namespace {

using namespace std::chrono_literals;

class MessageLoopTest : public testing::Test {
 protected:
  MessageLoopTest() { ros::Time::init(); }

  int watched_ = 0, handled_ = 0;
  MessageLoop loop_{{[this] { ++watched_; }, [this](SteadyTime) { ++handled_; }}};
};

TEST_F(MessageLoopTest, CallsAllCallbacksThatAreThere) {
  int called = 0;
  for (int i = 0; i < 5; ++i) call_later(loop_.queue(), [&] { ++called; });
  while (called < 5) loop_.receive(std::nullopt);
  EXPECT_GE(handled_, 5) << "after each callback";
  EXPECT_GE(watched_, handled_) << "before each callback, and after a batch";
}

TEST_F(MessageLoopTest, ReturnsWithoutACallbackAndHearsUntilThen) {
  const SteadyTime before = loop_.now();
  loop_.receive(std::nullopt);
  loop_.receive(loop_.now());
  loop_.receive(loop_.now() - 1s);
  EXPECT_EQ(handled_, 3);
  EXPECT_GE(loop_.heard_until(), before);
  EXPECT_LE(loop_.heard_until(), loop_.now());
}

TEST_F(MessageLoopTest, ThrowsWhatACallbackThrows) {
  call_later(loop_.queue(), [] { throw std::domain_error("broken"); });
  EXPECT_THROW(loop_.receive(std::nullopt), std::domain_error);
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
