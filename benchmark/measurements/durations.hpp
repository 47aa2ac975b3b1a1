#pragma once

#include <vector>

namespace organ_collision::bench {

/// A collection of durations [s].
class Durations {
 public:
  void add(double seconds) { seconds_.push_back(seconds); }
  std::size_t count() const { return seconds_.size(); }
  const std::vector<double>& all() const { return seconds_; }
  /// The duration that a `share` of all durations, in [0, 1], does not exceed. 0 if there are none.
  double quantile(double share) const;

 private:
  std::vector<double> seconds_;
};

}  // namespace organ_collision::bench
