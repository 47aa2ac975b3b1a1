#pragma once

#include <ros/time.h>

#include <optional>

#include "step_history.hpp"

namespace organ_collision {

/// The time that shapes wait for their transforms: simulated time if the node has it, and otherwise
/// the steady clock, which never jumps. Simulated time may stand still, because the simulator is
/// paused, or waits for the answer. After kStandstill of wall time, wall time counts in its place,
/// so that no shape waits for ever.
class WaitClock {
 public:
  static constexpr std::chrono::seconds kStandstill{2};

  /// Never goes back, even if simulated time does.
  SteadyTime now();
  /// The same for given clocks. `simulated`: std::nullopt if time is not simulated; zero if
  /// simulated time has not begun.
  SteadyTime now(std::optional<ros::Time> simulated, SteadyTime wall);

 private:
  ros::Time simulated_;  ///< at the last call
  SteadyTime counted_;   ///< the wall time up to which a standstill is judged
  SteadyTime time_;
};

}  // namespace organ_collision
