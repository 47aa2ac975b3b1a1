#include "answer_until.hpp"

#include <ros/init.h>

namespace organ_collision::bench {

void answer_until(ros::Time time, ros::CallbackQueue& queue) {
  for (ros::Time now = ros::Time::now(); now < time && ros::ok(); now = ros::Time::now()) {
    queue.callOne(ros::WallDuration((time - now).toSec()));
  }
}

}  // namespace organ_collision::bench
