#include "inbox.hpp"

#include <ros/console.h>

#include <algorithm>

namespace organ_collision {

void Inbox::subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  intake.subscribe(private_node);
  motion.subscribe(node);
}

void Inbox::watch_clock() {
  const ros::Time now = ros::Time::now();
  latest_ = std::max(latest_, now);
  ahead.look(now);
  if (now.toSec() < latest_.toSec() - kClockTolerance) {
    ROS_WARN("the clock jumped back from %f to %f s: all history is forgotten", latest_.toSec(),
             now.toSec());
    latest_ = now;
  } else if (!now.isZero() &&
             !ahead.fault(transforms.latest(), later(now, kClockTolerance)).empty()) {
    ROS_WARN(
        "the clock is at %f s, and transforms with stamps up to %f s had been taken before it "
        "began: all history is forgotten",
        now.toSec(), transforms.latest().toSec());
  } else {
    return;
  }
  begin_history("clock stepped back");
}

void Inbox::begin_history(const std::string& why) {
  transforms.clear();
  motion.forget_stamps();
  organs.begin_histories(why, ros::Time::now());
  history_ = {history_.number + 1, why};
}

}  // namespace organ_collision
