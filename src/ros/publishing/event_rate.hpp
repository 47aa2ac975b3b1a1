#pragma once

#include <chrono>
#include <cstdint>

namespace organ_collision {

/// Counts events and gives their rate.
class EventRate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit EventRate(Time start) : since_(start) {}
  void count() { ++count_; }
  /// [1/s] The rate since the last call, or since the start. 0 if no time has passed.
  double take(Time now);

 private:
  Time since_;
  std::uint64_t count_ = 0;
};

}  // namespace organ_collision
