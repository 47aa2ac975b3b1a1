#include "inbox.hpp"

#include <ros/console.h>

namespace organ_collision {

Inbox::Inbox(int max_faces, const std::vector<ToolParameters>& tools, const Sinks& sinks)
    : organs_(MeshLimits{static_cast<std::size_t>(max_faces)}),
      organ_topics_(organs_, sinks.rejected, sinks.callbacks),
      transform_topics_(transforms_, sinks.rejected),
      pose_topics_(tools, {transforms_, sinks.rejected, sinks.pose}) {}

void Inbox::subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  organ_topics_.subscribe(private_node);
  transform_topics_.subscribe(node);
  pose_topics_.subscribe(node);
}

bool Inbox::watch_clock() {
  const ros::Time now = ros::Time::now();
  const bool jumped_back = now < last_now_;
  if (jumped_back) {
    ROS_WARN("the clock jumped back from %f to %f s: all history is forgotten", last_now_.toSec(),
             now.toSec());
    transforms_.clear({last_now_, now});
    organs_.receive_anew(now);
  }
  last_now_ = now;
  const bool was_mixed = transforms_.has_started_anew();
  if (was_mixed) {
    ROS_WARN(
        "transforms of before the clock's jump had been taken: all history is forgotten again");
  }
  const bool starts_anew = was_mixed || jumped_back;
  if (starts_anew) {
    pose_topics_.forget_stamps();
    forget_organ_history();
  }
  return starts_anew;
}

void Inbox::forget_organ_history() {
  organs_.forget_previous_shapes();
  organs_.forget_connections();
}

}  // namespace organ_collision
