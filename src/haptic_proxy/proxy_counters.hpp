#pragma once

#include <chrono>
#include <cstdint>

#include "ros/messages/failure_log.hpp"
#include "ros/publishing/counters.hpp"
#include "ros/steps/duration_statistics.hpp"

namespace organ_collision {

/// What haptic_proxy counts for /diagnostics.
struct ProxyCounters {
  EventRate meshes{std::chrono::steady_clock::now()};  ///< accepted shapes of organs
  EventRate ticks{std::chrono::steady_clock::now()};
  DurationStatistics tick_times;
  std::uint64_t poses_merged = 0;  ///< poses that came while an earlier one still waited
  FailureLog rejected;             ///< messages that were refused
  FailureLog failed;               ///< ticks without an answer
  FailureLog clipped;              ///< forces that were reduced
  FailureLog placed_anew;          ///< proxies that left their place otherwise than by a motion
};

}  // namespace organ_collision
