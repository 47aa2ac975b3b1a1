#pragma once

#include <ros/callback_queue.h>
#include <ros/time.h>

#include <cstddef>

#include "benchmark/cases/timing.hpp"

namespace organ_collision::bench {

/// Handles messages as they arrive, until `time` or until ROS shuts down.
void answer_until(ros::Time time, ros::CallbackQueue& queue);

/// The latencies of a run, and how many answers were missing or wrong.
struct LatencyReport {
  double rate = 0.0;  ///< [Hz] of published messages
  std::size_t sent = 0;
  std::size_t skipped = 0;   ///< messages to which not all answers arrived
  std::size_t failed = 0;    ///< answers that say that there is none
  bool late = false;         ///< whether the sender failed to publish at that rate
  double query_sec = 0.0;    ///< [s] the node's median time of a query; 0 if it tells none
  Durations latencies = {};  ///< from publishing a message to receiving the last answer to it
};

/// Prints a report as a line of JSON, with all latencies, in microseconds.
void print(const char* what, const LatencyReport& report);

}  // namespace organ_collision::bench
