#include "inbox.hpp"

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

bool Inbox::watch_clock() {
  const ros::Time now = ros::Time::now();
  const bool has_jumped_back = clock_.has_jumped_back(now);
  // They were taken before simulated time began.
  const bool are_ahead =
      !ahead_fault(transforms_.latest(), now, max_ahead_sec_ + kClockTolerance).empty();
  if (has_jumped_back) jumped_ = now.toSec();
  const bool is_mixed = transforms_.has_stepped_back() && now.toSec() - jumped_ < kArrival;
  if (!has_jumped_back && !are_ahead && !is_mixed) return false;
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
