#pragma once

#include <ros/time.h>

#include <deque>
#include <vector>

namespace organ_collision {

/// The stamps of the recent transforms of one frame. It forgets a stamp when TF forgets the
/// transform, or when there are more than kMost stamps.
class StampRecord {
 public:
  /// As many transforms as TF keeps at 1 kHz.
  static constexpr std::size_t kMost = 10'000;

  /// `kept`: how long TF keeps a transform, counted back from the latest one.
  explicit StampRecord(ros::Duration kept) : kept_(kept) {}

  void add(ros::Time stamp);
  bool contains(ros::Time stamp) const;
  bool empty() const { return rising_.empty(); }
  void clear() { *this = StampRecord(kept_); }
  /// The largest stamp; zero if there is none.
  ros::Time latest() const { return empty() ? ros::Time() : rising_.back(); }
  /// The stamp that came last; zero if there is none.
  ros::Time heard() const { return heard_; }
  /// The latest stamp that was forgotten; zero if there is none.
  ros::Time forgotten() const { return forgotten_; }
  /// Appends the stamps after `from` and before `to`, in rising order.
  void append_between(ros::Time from, ros::Time to, std::vector<ros::Time>& stamps) const;

 private:
  ros::Duration kept_;
  std::deque<ros::Time> rising_;
  ros::Time heard_, forgotten_;
};

}  // namespace organ_collision
