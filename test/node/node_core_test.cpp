#include "node/node_core.hpp"

#include <gtest/gtest.h>
#include <ros/time.h>

#include <chrono>
#include <stdexcept>

namespace organ_collision {
namespace {

using namespace std::chrono_literals;

/// A node that counts what the loop calls around each callback.
class CountingNode final : public OrganNode {
 public:
  void start() override {}
  void watch_clock() override { ++watched; }
  void handle(SteadyTime) override { ++handled; }
  void work() override {}
  std::optional<SteadyTime> next_deadline() override { return deadline; }
  void reset() override {}
  void parameters_changed() override {}
  std::function<void()> prepare_tools(std::vector<Tool>&, const KeptTools&) override { return {}; }
  void release_tools(const KeptTools&) override {}
  void end(const std::exception*) override {}

  int watched = 0, handled = 0;
  std::optional<SteadyTime> deadline = {};
};

class MessageLoopTest : public testing::Test {
 protected:
  MessageLoopTest() { ros::Time::init(); }

  void receive(std::optional<SteadyTime> deadline = {}) {
    node_.deadline = deadline;
    loop_.receive(node_);
  }

  CountingNode node_;
  MessageLoop loop_;
};

TEST_F(MessageLoopTest, CallsAllCallbacksThatAreThere) {
  int called = 0;
  for (int i = 0; i < 5; ++i) call_later(loop_.queue(), [&] { ++called; });
  while (called < 5) receive();
  EXPECT_GE(node_.handled, 5) << "after each callback";
  EXPECT_GE(node_.watched, node_.handled) << "before each callback, and after a batch";
}

TEST_F(MessageLoopTest, ThrowsWhatACallbackThrows) {
  call_later(loop_.queue(), [] { throw std::domain_error("broken"); });
  EXPECT_THROW(receive(), std::domain_error);
}

}  // namespace
}  // namespace organ_collision
