#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <atomic>
#include <optional>

#include "repeated.hpp"

namespace organ_collision::stress {

/// Publishes /clock, which runs as fast as real time and can jump backwards.
class SimulatedClock {
 public:
  SimulatedClock();

  /// Sets the clock back, as a simulator does that is reset.
  void jump_back() { jumps_ = true; }

 private:
  void publish();

  ros::NodeHandle node_;
  ros::Publisher clock_;
  std::atomic<bool> jumps_ = false;
  ros::Time now_{100.0};
  ros::WallTime last_ = ros::WallTime::now();
  std::optional<Repeated> ticks_;
};

}  // namespace organ_collision::stress
