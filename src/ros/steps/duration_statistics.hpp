#pragma once

#include <array>
#include <cstddef>

namespace organ_collision {

/// Statistics of the durations of the last kCapacity events [s].
class DurationStatistics {
 public:
  static constexpr std::size_t kCapacity = 4096;

  struct Summary {
    std::size_t count = 0;  ///< of all events since the start; without events, all members are 0
    double median = 0.0;
    double percentile_99 = 0.0;
    double worst = 0.0;
  };

  void add(double seconds) { seconds_[count_++ % kCapacity] = seconds; }
  /// The duration of the last event; 0 if there was none.
  double latest() const { return count_ > 0 ? seconds_[(count_ - 1) % kCapacity] : 0.0; }
  /// The percentile p is the smallest duration that at least p percent of the events do not exceed.
  Summary summary() const;

 private:
  std::array<double, kCapacity> seconds_{};
  std::size_t count_ = 0;
};

}  // namespace organ_collision
