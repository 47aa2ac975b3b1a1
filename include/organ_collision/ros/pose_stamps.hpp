#pragma once

#include <ros/time.h>

#include <deque>
#include <vector>

namespace organ_collision {

/// When the poses of a tip were that came as messages lately.
class PoseStamps {
 public:
  void add(ros::Time stamp);
  /// Those after `from` and before `to`, rising.
  std::vector<ros::Time> between(ros::Time from, ros::Time to) const;

 private:
  std::deque<ros::Time> rising_;
};

}  // namespace organ_collision
