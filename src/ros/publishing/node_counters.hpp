#pragma once

#include <chrono>
#include <cstdint>

#include "event_rate.hpp"
#include "ros/interface/failure_log.hpp"

namespace organ_collision {

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

}  // namespace organ_collision
