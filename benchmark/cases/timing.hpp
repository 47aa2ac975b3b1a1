#pragma once

#include <chrono>
#include <vector>

#include "benchmark/scenes/volume_query.hpp"

namespace organ_collision::bench {

/// Measures the time from one lap to the next.
class Stopwatch {
 public:
  /// Seconds since the last lap, or since construction.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - last_;
    last_ = now;
    return passed.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

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

/// The outcome of checking a measurement's answers against the reference, over all of its steps.
struct CheckSummary {
  Errors errors;
  double hits = 0.0;  ///< average number of faces in the reference answer to a query

  void add(const Errors& found) {
    errors.missed += found.missed;
    errors.wrong += found.wrong;
  }
};

}  // namespace organ_collision::bench
