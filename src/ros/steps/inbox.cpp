#include "inbox.hpp"

#include <ros/console.h>

namespace organ_collision {
namespace {

/// [s] of ROS time: what was on its way during a jump has arrived by then.
constexpr double kArrival = 2.0;
/// No more often after a jump: a frame with two senders may step back again and again.
constexpr int kMostForgotten = 3;

}  // namespace

void Inbox::subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  intake.subscribe(private_node);
  motion.subscribe(node);
}

bool Inbox::watch_clock() {
  const ros::Time now = ros::Time::now();
  if (clock_.has_jumped_back(now)) {
    jumped_ = now.toSec();
    may_forget_ = kMostForgotten;
  } else if (transforms.has_stepped_back() && may_forget_ > 0 && now.toSec() - jumped_ < kArrival) {
    --may_forget_;
    ROS_WARN(
        "transforms of before the clock's jump had been taken: all history is forgotten again");
  } else if (!ahead_fault(transforms.latest(), now, max_ahead_sec_ + kClockTolerance).empty()) {
    ROS_WARN(
        "the clock is at %f s, and transforms with stamps up to %f s had been taken before it "
        "began: all history is forgotten",
        now.toSec(), transforms.latest().toSec());
  } else {
    return false;
  }
  organs.receive_anew(now);
  forget_history();
  return true;
}

void Inbox::forget_history() {
  transforms.clear();
  motion.forget_stamps();
  organs.forget_history();
}

}  // namespace organ_collision
