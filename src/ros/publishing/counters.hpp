#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>

#include "ros/messages/failure_log.hpp"
#include "ros/steps/duration_statistics.hpp"

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

/// What the node counts for /diagnostics.
struct NodeCounters {
  EventRate meshes{std::chrono::steady_clock::now()};    ///< accepted shapes of organs
  EventRate contacts{std::chrono::steady_clock::now()};  ///< answers to steps
  std::uint64_t published = 0;  ///< answers on `contacts`, also those about refused messages
  std::uint64_t starting = 0;   ///< steps without TF that may be starting
  FailureLog rejected;          ///< messages that were refused
  FailureLog failed;            ///< steps without an answer
  FailureLog incomplete;        ///< steps with an answer whose path is not wholly known
  FailureLog refused;           ///< service calls without an answer
};

/// Counts what the services have answered, for /diagnostics. Any thread may use it at any time.
class ServiceStatistics {
 public:
  struct Summary {
    DurationStatistics::Summary queries;  ///< single ones: their number and times
    std::size_t batches = 0;              ///< that were answered to the end
    std::size_t motions = 0;              ///< of all batches, also of the present one
  };

  /// `seconds`: the time that a single query took, without the time in which it waited.
  void add_query(double seconds) {
    const std::lock_guard<std::mutex> lock(mutex_);
    counts_.queries.add(seconds);
  }
  void add_batch() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.batches;
  }
  /// `motions`: how many of a batch were answered since the last call.
  void add_motions(std::size_t motions) {
    const std::lock_guard<std::mutex> lock(mutex_);
    counts_.motions += motions;
  }
  Summary summary() const {
    const Counts counts = copy();
    return {counts.queries.summary(), counts.batches, counts.motions};
  }

 private:
  struct Counts {
    DurationStatistics queries;
    std::size_t batches = 0;
    std::size_t motions = 0;
  };

  /// Only this needs the lock. Percentiles take longer, and are computed without it.
  Counts copy() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return counts_;
  }

  mutable std::mutex mutex_;
  Counts counts_;
};

}  // namespace organ_collision
