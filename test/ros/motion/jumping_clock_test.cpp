// A clock that jumps, and a node that stands still now and then: what TF interpolates for the node
// must be of one time.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <random>

#include "hand_filled_transforms.hpp"
#include "ros/motion/transform_lookup.hpp"

using namespace organ_collision;

namespace {

using Tick = std::int64_t;  // [ms]
constexpr std::size_t kShapes = 10;

ros::Time stamp_of(Tick tick) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(tick) * 1'000'000U);
}

/// [m] Where the tip is at a tick, also at the next visit of that time.
double height(Tick tick) { return std::sin(0.01 * static_cast<double>(tick)); }

class JumpingClockTest : public testing::TestWithParam<unsigned> {
 protected:
  JumpingClockTest() { ros::Time::init(); }

  /// The simulator goes on, and the node does not.
  void simulate(Tick ticks) {
    for (; ticks > 0; --ticks) {
      if (happens(0.002)) jump();
      on_their_way_.push_back(++tick_);
      shapes_.push_back(tick_);
      if (shapes_.size() > kShapes) shapes_.pop_front();
    }
  }

  /// The node goes on. It reads the newest /clock before or between the transforms. The last ones
  /// may still be on their way.
  void wake() {
    const Tick clock_comes = draw(0, 3);
    const auto left = static_cast<std::size_t>(draw(0, 5));
    for (Tick taken = 0; on_their_way_.size() > left; ++taken, on_their_way_.pop_front()) {
      if (taken == clock_comes) watch_clock();
      const ros::Time stamp = stamp_of(on_their_way_.front());
      if (!buffer_.admit("tip", stamp)) continue;
      set_point(buffer_, "world", "tip", stamp.toSec(), {0.0, 0.0, height(on_their_way_.front())});
    }
    watch_clock();
  }

  /// Looks the newest shapes' poses up. After a jump back that the node cannot notice, poses of
  /// times before the jump may be wrong.
  void check() {
    for (const Tick shape : shapes_) {
      if (is_unnoticed_ && shape <= before_jump_) continue;
      const auto found = look_up(buffer_, "world", "tip", stamp_of(shape)).found;
      if (!found) continue;
      ++found_;
      ASSERT_NEAR(found->value.translation().z(), height(shape), 1e-3) << "at tick " << shape;
    }
  }

  bool happens(double probability) {
    return std::uniform_real_distribution<>()(random_) < probability;
  }
  Tick draw(Tick least, Tick most) {
    return std::uniform_int_distribution<Tick>(least, most)(random_);
  }

  std::mt19937 random_{GetParam()};
  int found_ = 0;

 private:
  void jump() {
    const bool is_back = happens(0.5) && tick_ > 50'000;
    if (is_back) {
      before_jump_ = std::max(before_jump_, tick_);
      is_unnoticed_ = true;
    }
    tick_ += (is_back ? -1 : 1) * draw(200, 3000);
  }

  /// As Inbox does.
  void watch_clock() {
    const ros::Time now = stamp_of(tick_);
    ros::Time::setNow(now);
    if (now < last_now_) {
      buffer_.clear({last_now_, now});
      is_unnoticed_ = false;
    }
    last_now_ = now;
  }

  TransformBuffer buffer_;
  std::deque<Tick> on_their_way_;  ///< transforms
  std::deque<Tick> shapes_;        ///< the newest
  Tick tick_ = 100'000;
  Tick before_jump_ = 0;
  bool is_unnoticed_ = false;
  ros::Time last_now_;
};

TEST_P(JumpingClockTest, PosesAreOfOneTime) {
  for (int i = 0; i < 2000; ++i) {
    simulate(happens(0.02) ? draw(50, 800) : draw(1, 3));
    wake();
    check();
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(found_, 1000);
}

INSTANTIATE_TEST_SUITE_P(Seeds, JumpingClockTest, testing::Range(0U, 40U));

}  // namespace
