#pragma once

#include <cstddef>
#include <mutex>

#include "ros/steps/duration_statistics.hpp"

namespace organ_collision {

/// Counts what the services have answered, for /diagnostics. Any thread may use it at any time.
class ServiceTimes {
 public:
  struct Summary {
    DurationStatistics::Summary queries;  ///< single ones: their number and times
    std::size_t batches = 0;
    std::size_t motions = 0;  ///< of all batches
  };

  /// `seconds`: the time that a single query took, without the time in which it waited.
  void add_query(double seconds) {
    const std::lock_guard<std::mutex> lock(mutex_);
    queries_.add(seconds);
  }
  /// `motions`: how many of a batch were answered.
  void add_batch(std::size_t motions) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++batches_;
    motions_ += motions;
  }
  Summary summary() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {queries_.summary(), batches_, motions_};
  }

 private:
  mutable std::mutex mutex_;
  DurationStatistics queries_;
  std::size_t batches_ = 0;
  std::size_t motions_ = 0;
};

}  // namespace organ_collision
