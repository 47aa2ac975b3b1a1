#pragma once

#include <chrono>
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
  double take(Time now) {
    const double seconds = std::chrono::duration<double>(now - since_).count();
    const double rate = seconds > 0.0 ? static_cast<double>(count_) / seconds : 0.0;
    since_ = now;
    count_ = 0;
    return rate;
  }

 private:
  Time since_;
  std::uint64_t count_ = 0;
};

/// Counts what the services have answered. Any thread may use it at any time.
class ServiceStatistics {
 public:
  struct Counts {
    DurationStatistics queries;  ///< single ones, without the time in which they waited
    std::uint64_t batches = 0;   ///< that were answered to the end
    std::uint64_t motions = 0;   ///< of all batches, also of the present one
  };

  /// `seconds`: the time that a single query took.
  void add_query(double seconds) {
    const std::lock_guard<std::mutex> lock(mutex_);
    counts_.queries.add(seconds);
  }
  void add_batch() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.batches;
  }
  void add_motion() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.motions;
  }
  Counts counts() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return counts_;
  }

 private:
  mutable std::mutex mutex_;
  Counts counts_;
};

/// What the node counts for /diagnostics.
struct NodeCounters {
  EventRate meshes{std::chrono::steady_clock::now()};    ///< accepted shapes of organs
  EventRate contacts{std::chrono::steady_clock::now()};  ///< answers to steps
  std::uint64_t published = 0;  ///< answers on `contacts`, also those about refused messages
  std::uint64_t starting = 0;   ///< steps without TF that may be starting
  ServiceStatistics services;
  FailureLog rejected;    ///< messages that were refused
  FailureLog failed;      ///< steps without an answer
  FailureLog incomplete;  ///< steps with an answer whose path is not wholly known
  FailureLog refused;     ///< service calls without an answer
};

}  // namespace organ_collision
