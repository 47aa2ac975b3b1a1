#include "inbox.hpp"

#include <ros/console.h>

namespace organ_collision {

Inbox::Inbox(const Limits& limits, const std::vector<ToolParameters>& tools, const Sinks& sinks)
    : max_ahead_sec_(limits.max_ahead_sec),
      organs_(MeshLimits{static_cast<std::size_t>(limits.max_faces)}, limits.max_ahead_sec),
      organ_topics_(organs_, sinks.rejected, sinks.callbacks),
      transform_topics_(transforms_, sinks.rejected, limits.max_ahead_sec),
      pose_topics_(tools, {transforms_, sinks.rejected, sinks.pose, limits.max_ahead_sec}) {}

void Inbox::subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  organ_topics_.subscribe(private_node);
  transform_topics_.subscribe(node);
  pose_topics_.subscribe(node);
}

bool Inbox::is_too_far_ahead(ros::Time stamp, ros::Time now) const {
  return !ahead_fault(stamp, now, max_ahead_sec_ + kClockTolerance).empty();
}

bool Inbox::watch_clock() {
  const ros::Time now = ros::Time::now();
  if (clock_.has_jumped_back(now)) {
    jumped_ = now.toSec();
    may_forget_ = kMostForgotten;
  } else if (transforms_.has_stepped_back() && may_forget_ > 0 &&
             now.toSec() - jumped_ < kArrival) {
    --may_forget_;
    ROS_WARN(
        "transforms of before the clock's jump had been taken: all history is forgotten again");
  } else if (is_too_far_ahead(transforms_.latest(), now)) {
    ROS_WARN(
        "the clock is at %f s, and transforms with stamps up to %f s had been taken before it "
        "began: all history is forgotten",
        now.toSec(), transforms_.latest().toSec());
  } else {
    return false;
  }
  organs_.receive_anew(now);
  forget_history();
  return true;
}

void Inbox::forget_history() {
  transforms_.clear();
  pose_topics_.forget_stamps();
  organs_.forget_previous_shapes();
  organs_.forget_connections();
}

}  // namespace organ_collision
