#pragma once

#include <ros/time.h>

#include <deque>
#include <vector>

namespace organ_collision {

/// The stamps that the transforms of one frame had lately. It forgets those that TF forgets, and
/// the oldest of too many.
class StampRecord {
 public:
  /// As many as TF keeps at 1 kHz.
  static constexpr std::size_t kMost = 10'000;

  /// `kept`: as long before the latest one TF keeps transforms.
  explicit StampRecord(ros::Duration kept) : kept_(kept) {}

  void add(ros::Time stamp);
  bool contains(ros::Time stamp) const;
  bool empty() const { return rising_.empty(); }
  void clear() { rising_.clear(); }
  /// Appends those after `from` and before `to`, rising.
  void append_between(ros::Time from, ros::Time to, std::vector<ros::Time>& stamps) const;

 private:
  ros::Duration kept_;
  std::deque<ros::Time> rising_;
};

}  // namespace organ_collision
