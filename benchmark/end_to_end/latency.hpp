#pragma once

#include <vector>

namespace organ_collision::bench {

/// Durations of many calls [s].
class Latencies {
 public:
  void add(double seconds) { seconds_.push_back(seconds); }
  std::size_t count() const { return seconds_.size(); }
  /// The duration that `share` of them, in [0, 1], do not exceed; 0 if there is none.
  double quantile(double share) const;

 private:
  std::vector<double> seconds_;
};

}  // namespace organ_collision::bench
