// A model of tools that obey the guard: 10 000 random approaches to moving tissue. A tool that
// obeys never touches, unless the tissue alone comes faster than the tool may retreat.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <deque>
#include <random>
#include <sstream>
#include <string>

#include "common/messages/conversions.hpp"
#include "guard/tool_guard.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {
namespace {

constexpr double kStep = 0.0005;         ///< [s] of the model
constexpr double kLongestWait = 0.0225;  ///< [s] between two states without answers

enum class Fault { kNone, kNodeEnds, kGuardEnds };

/// How an approach ended.
struct Outcome {
  bool tool_touched = false;    ///< while it moved towards the tissue
  bool tissue_touched = false;  ///< while the tool stood or went back
  double least = kUnlimited;    ///< [m]
};

/// One tool that moves towards tissue along a line. The tissue's speed is drawn once. Wishes of the
/// operator change, and so do the delays of the messages, whose order is kept.
class Approach {
 public:
  explicit Approach(unsigned seed) : random_(seed) {
    p_.deceleration = uniform(0.5, 10.0);
    p_.latency = uniform(0.12, 0.4);
    p_.watch_time = uniform(0.03, 0.1);
    p_.stop_distance = uniform(1e-4, 3e-3);
    p_.max_speed = uniform(0.05, 0.5);
    p_.hold_sec = one_of(2) ? 0.0 : uniform(0.0, 0.2);
    p_.tissue_speed = 0.5;
    const double speeds[] = {0.0, uniform(-0.5, 0.5), uniform(0.0, 0.95 * p_.retreat_speed)};
    tissue_ = speeds[one_of(3)];
    distance_ = uniform(p_.stop_distance + 0.001, 0.3);
    answer_delay_ = uniform(0.0, 0.9 * p_.longest_age());
    state_delay_ = uniform(0.0, (p_.latency - p_.watch_time) / 3.0);
    period_ = uniform(0.001, 0.016);
    shape_period_ = uniform(0.001, 0.05);
    noise_ = one_of(2) ? 0.0 : p_.stop_distance;
    fault_ = one_of(2) ? Fault::kNone : one_of(2) ? Fault::kNodeEnds : Fault::kGuardEnds;
    fault_time_ = uniform(0.0, 2.0);
    steady_push_ = one_of(4) == 0;
    OrganInfo organ;
    organ.name = "tissue";
    guard_.set_organs({organ}, 0.0);
  }

  Outcome run(double duration) {
    Outcome outcome;
    for (time_ = 0.0; time_ < duration; time_ += kStep) {
      answer();
      guard();
      move();
      outcome.least = std::min(outcome.least, distance_);
      if (distance_ > 0.0) continue;
      (speed_ > 0.0 ? outcome.tool_touched : outcome.tissue_touched) = true;
      break;
    }
    return outcome;
  }

  /// Whether the operator pushes on to tissue at rest whose distance is known.
  bool pushes_to_rest() const {
    return steady_push_ && tissue_ == 0.0 && noise_ == 0.0 && fault_ == Fault::kNone;
  }
  /// Whether tissue may touch a tool that does not go on: it comes faster than the tool may go
  /// back, or nobody tells the tool any more where back is.
  bool may_be_touched() const {
    return tissue_ > p_.retreat_speed ||
           (tissue_ > 0.0 && fault_ != Fault::kNone && is_over(fault_));
  }
  double error() const { return p_.stop_distance; }
  std::string in_words() const {
    std::ostringstream text;
    text.precision(17);
    text << "a " << p_.deceleration << " T " << p_.latency << " watch " << p_.watch_time << " e "
         << p_.stop_distance << " max " << p_.max_speed << " hold " << p_.hold_sec << " tissue "
         << tissue_ << " delays " << answer_delay_ << " " << state_delay_ << " periods " << period_
         << " " << shape_period_ << " noise " << noise_ << " fault " << static_cast<int>(fault_)
         << " at " << fault_time_ << "; at " << time_ << " speed " << speed_;
    return text.str();
  }

 private:
  template <typename Message>
  struct Delayed {
    double arrives;
    Message message;
  };

  double uniform(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random_);
  }
  unsigned one_of(unsigned count) { return static_cast<unsigned>(random_() % count); }
  /// When a message that takes `delay` arrives: not before the one that was sent before it.
  template <typename Queue>
  double arrival(const Queue& queue, double delay) const {
    return std::max(time_ + delay, queue.empty() ? 0.0 : queue.back().arrives);
  }
  bool is_over(Fault fault) const { return fault_ == fault && time_ >= fault_time_; }
  ros::Time ros_time() const { return ros::Time(100.0 + time_); }

  /// The collision node measures.
  void answer() {
    if (time_ < next_answer_ || is_over(Fault::kNodeEnds)) return;
    next_answer_ += period_;
    if (time_ >= shape_time_ + shape_period_) shape_time_ = time_;
    auto answer = boost::make_shared<ContactArray>();
    answer->header.stamp = ros_time();
    answer->mesh_stamp = ros::Time(100.0 + shape_time_);
    answer->organ = "tissue";
    answer->placement.tip = ToolPlacement::OUTSIDE;
    Clearance& clearance = answer->clearance;
    clearance.state = Clearance::KNOWN;
    clearance.margin = 10.0;
    const double since_shape = tissue_ * (time_ - shape_time_);
    clearance.distance = distance_ + since_shape + uniform(-noise_, noise_);
    clearance.normal.x = 1.0;
    clearance.normal_defined = 1;
    Contact& near = answer->near.emplace_back();
    near.depth = -clearance.distance;
    near.normal.x = 1.0;
    near.velocity.x = -tissue_;
    answers_.push_back({arrival(answers_, uniform(0.0, answer_delay_)), answer});
  }

  void guard() {
    if (is_over(Fault::kGuardEnds)) return;
    bool decides = false;
    while (!answers_.empty() && answers_.front().arrives <= time_) {
      guard_.take(answers_.front().message, {0.0, 0.0, 0.0}, {time_, ros_time()});
      answers_.pop_front();
      decides = true;
    }
    if (!decides && time_ < last_sent_ + kLongestWait) return;
    last_sent_ = time_;
    states_.push_back(
        {arrival(states_, uniform(0.0, state_delay_)), guard_.decide({time_, ros_time()})});
  }

  /// The tool obeys: it speeds up at once, and slows down with its deceleration.
  void move() {
    while (!states_.empty() && states_.front().arrives <= time_) {
      state_ = states_.front().message;
      heard_ = time_;
      states_.pop_front();
    }
    if (time_ >= next_wish_) {
      next_wish_ = time_ + uniform(0.02, 0.4);
      wish_ = steady_push_ ? 0.5 : std::max(0.0, uniform(-0.2, 0.5));
    }
    const bool is_heard = time_ - heard_ < p_.watch_time;
    double target = is_heard ? std::min(wish_, state_.speed_scale * p_.max_speed) : 0.0;
    const bool may_retreat = is_heard && state_.retreat.x < 0.0;
    if (target == 0.0 && may_retreat && tissue_ > 0.0) target = -p_.retreat_speed;
    const double before = speed_;
    speed_ = std::max(target, before - p_.deceleration * kStep);
    const double mean = before > speed_ ? 0.5 * (before + speed_) : speed_;
    distance_ -= (mean + tissue_) * kStep;
  }

  std::mt19937 random_;
  GuardParameters p_;
  ToolGuard guard_{p_, [] {
                     ToolInfo tool;
                     tool.name = "tool";
                     tool.margin = 10.0;
                     return tool;
                   }()};
  double tissue_ = 0.0, distance_ = 0.0, answer_delay_ = 0.0, state_delay_ = 0.0, period_ = 0.0,
         shape_period_ = 0.0, noise_ = 0.0;
  Fault fault_ = Fault::kNone;
  double fault_time_ = 0.0;
  bool steady_push_ = false;

  double time_ = 0.0, next_answer_ = 0.0, last_sent_ = -1.0, heard_ = -1.0, next_wish_ = 0.0,
         wish_ = 0.0, speed_ = 0.0, shape_time_ = 0.0;
  std::deque<Delayed<ContactArray::ConstPtr>> answers_;
  std::deque<Delayed<GuardState>> states_;
  GuardState state_;
};

TEST(GuardModel, AToolThatObeysDoesNotTouch) {
  double unused = 0.0;
  unsigned pushed = 0, touched_by_tissue = 0;
  for (unsigned seed = 0; seed < 10'000; ++seed) {
    Approach approach(seed);
    // In 12 s, also the slowest tool comes to the end of the longest way.
    const Outcome outcome = approach.run(approach.pushes_to_rest() ? 12.0 : 3.0);
    ASSERT_FALSE(outcome.tool_touched) << seed << ": " << approach.in_words();
    touched_by_tissue += outcome.tissue_touched;
    ASSERT_TRUE(approach.may_be_touched() || !outcome.tissue_touched)
        << seed << ": " << approach.in_words();
    if (!approach.pushes_to_rest()) continue;
    ++pushed;
    unused = std::max(unused, outcome.least - approach.error());
  }
  std::printf(
      "%u approaches pushed on for 12 s to tissue at rest; the largest unused distance is %.3g m. "
      "Fast "
      "tissue touched %u tools that stood or went back\n",
      pushed, unused, touched_by_tissue);
  EXPECT_GT(pushed, 150u);
  EXPECT_GT(touched_by_tissue, 100u);
  EXPECT_LT(unused, 2e-4);
}

}  // namespace
}  // namespace organ_collision
