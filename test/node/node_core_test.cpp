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
  CountingNode() : OrganNode(inbox_) {}

  void start() override {}
  void handle(SteadyTime) override { ++handled; }
  std::optional<SteadyTime> work() override { return {}; }
  void parameters_changed() override {}
  std::function<void()> prepare_tools(std::vector<Tool>&, const KeptTools&) override { return {}; }
  void end(const std::exception*) override {}

  int handled = 0;

 private:
  FailureLog rejected_;
  Inbox inbox_{OrganNodeParameters{}, rejected_, [](std::size_t) {}};
};

class MessageLoopTest : public testing::Test {
 protected:
  MessageLoopTest() { ros::Time::init(); }

  void receive(std::optional<SteadyTime> deadline = {}) { loop_.receive(node_, deadline); }

  CountingNode node_;
  MessageLoop loop_;
};

TEST_F(MessageLoopTest, CallsAllCallbacksThatAreThere) {
  int called = 0;
  for (int i = 0; i < 5; ++i) call_later(loop_.queue(), [&] { ++called; });
  while (called < 5) receive();
  EXPECT_GE(node_.handled, 10) << "before and after each callback";
}

TEST_F(MessageLoopTest, ThrowsWhatACallbackThrows) {
  call_later(loop_.queue(), [] { throw std::domain_error("broken"); });
  EXPECT_THROW(receive(), std::domain_error);
}

}  // namespace
}  // namespace organ_collision
