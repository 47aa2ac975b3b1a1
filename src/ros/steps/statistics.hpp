#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace organ_collision {

/// Durations of the last kCapacity events [s].
class DurationStatistics {
 public:
  static constexpr std::size_t kCapacity = 4096;

  struct Summary {
    std::size_t count = 0;  ///< all zero without events
    double median = 0.0;
    double percentile_99 = 0.0;
    double worst = 0.0;
  };

  void add(double seconds) { seconds_[count_++ % kCapacity] = seconds; }
  /// A percentile is the smallest duration that so many percent of all do not exceed.
  Summary summary() const;

 private:
  std::array<double, kCapacity> seconds_;
  std::size_t count_ = 0;
};

/// How often something happened between two looks at it.
class EventRate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit EventRate(Time start) : since_(start) {}
  void count() { ++count_; }
  /// [1/s] since the last call; starts anew. 0 if no time has passed.
  double take(Time now);

 private:
  Time since_;
  std::uint64_t count_ = 0;
};

}  // namespace organ_collision
