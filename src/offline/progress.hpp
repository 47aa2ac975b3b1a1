#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

namespace organ_collision {

/// Prints on stderr, at most once a second, how many motions are done. A run of less than a second
/// prints nothing.
class Progress {
 public:
  /// `total`: how many motions there are, if that is known.
  explicit Progress(std::optional<std::size_t> total) : total_(total) {}

  void report(std::size_t done);

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<std::size_t> total_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace organ_collision
