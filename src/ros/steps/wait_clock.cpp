#include "wait_clock.hpp"

namespace organ_collision {

SteadyTime WaitClock::now() {
  const bool simulates = ros::Time::isSimTime();
  return now(simulates ? std::optional(ros::Time::now()) : std::nullopt,
             std::chrono::steady_clock::now());
}

SteadyTime WaitClock::now(std::optional<ros::Time> simulated, SteadyTime wall) {
  if (!simulated) return wall;
  if (*simulated != simulated_) {
    // The first time of the simulator is no duration.
    if (*simulated > simulated_ && !simulated_.isZero()) {
      time_ += std::chrono::nanoseconds(simulated->toNSec() - simulated_.toNSec());
    }
    simulated_ = *simulated;
    counted_ = wall;
  } else if (wall - counted_ > kStandstill) {
    time_ += wall - counted_ - kStandstill;
    counted_ = wall - kStandstill;
  }
  return time_;
}

}  // namespace organ_collision
