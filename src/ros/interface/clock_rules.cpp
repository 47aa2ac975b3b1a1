#include "clock_rules.hpp"

#include <ros/console.h>

#include <algorithm>

#include "geometry/concatenate.hpp"

namespace organ_collision {

std::string ahead_fault(ros::Time stamp, ros::Time now, double max_ahead_sec) {
  const double ahead_sec = stamp.toSec() - now.toSec();
  if (now.isZero() || ahead_sec <= max_ahead_sec) return {};
  return concatenate("the stamp ", stamp, " is ", ahead_sec,
                     " s ahead of this node's clock; at most ", max_ahead_sec,
                     " s are allowed (max_ahead_sec). The sender needs the same clock");
}

bool ClockWatch::has_jumped_back(ros::Time now) {
  const bool has_jumped = now.toSec() < latest_.toSec() - kClockTolerance;
  if (has_jumped) {
    ROS_WARN("the clock jumped back from %f to %f s: all history is forgotten", latest_.toSec(),
             now.toSec());
  }
  latest_ = has_jumped ? now : std::max(latest_, now);
  return has_jumped;
}

}  // namespace organ_collision
