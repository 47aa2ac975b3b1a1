#include "stamp_record.hpp"

#include <algorithm>
#include <cstdint>

namespace organ_collision {

void StampRecord::add(ros::Time stamp) {
  heard_ = stamp;
  rising_.insert(std::upper_bound(rising_.begin(), rising_.end(), stamp), stamp);
  // In whole nanoseconds, because the arithmetic of ros::Time throws for extreme stamps.
  const std::uint64_t latest = rising_.back().toNSec();
  const auto kept = static_cast<std::uint64_t>(kept_.toNSec());
  while (rising_.size() > kMost || latest - rising_.front().toNSec() > kept) {
    forgotten_ = std::max(forgotten_, rising_.front());
    rising_.pop_front();
  }
}

bool StampRecord::contains(ros::Time stamp) const {
  return std::binary_search(rising_.begin(), rising_.end(), stamp);
}

void StampRecord::append_between(ros::Time from, ros::Time to,
                                 std::vector<ros::Time>& stamps) const {
  const auto begin = std::upper_bound(rising_.begin(), rising_.end(), from);
  const auto end = std::lower_bound(begin, rising_.end(), to);
  stamps.insert(stamps.end(), begin, end);
}

}  // namespace organ_collision
