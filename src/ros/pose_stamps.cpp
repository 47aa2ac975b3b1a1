#include "organ_collision/ros/pose_stamps.hpp"

#include <algorithm>

namespace organ_collision {

void PoseStamps::add(ros::Time stamp) {
  // As many as TF keeps for ten seconds at 1 kHz.
  constexpr std::size_t kMost = 10'000;
  rising_.insert(std::upper_bound(rising_.begin(), rising_.end(), stamp), stamp);
  if (rising_.size() > kMost) rising_.pop_front();
}

std::vector<ros::Time> PoseStamps::between(ros::Time from, ros::Time to) const {
  const auto begin = std::upper_bound(rising_.begin(), rising_.end(), from);
  return {begin, std::lower_bound(begin, rising_.end(), to)};
}

}  // namespace organ_collision
