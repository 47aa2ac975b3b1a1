#pragma once

#include <ros/callback_queue.h>
#include <ros/time.h>

namespace organ_collision::bench {

/// Handles messages as they arrive, until `time` or until ROS shuts down.
void answer_until(ros::Time time, ros::CallbackQueue& queue);

}  // namespace organ_collision::bench
