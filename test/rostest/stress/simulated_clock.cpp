#include "simulated_clock.hpp"

#include <rosgraph_msgs/Clock.h>

namespace organ_collision::stress {
namespace {

constexpr double kTick = 1e-3;  // [s]
const ros::Duration kJump(1.0);
const ros::Time kEarliest(50.0);

}  // namespace

SimulatedClock::SimulatedClock() : clock_(node_.advertise<rosgraph_msgs::Clock>("/clock", 10)) {
  ticks_.emplace(kTick, [this] { publish(); });
}

void SimulatedClock::publish() {
  const ros::WallTime wall = ros::WallTime::now();
  now_ += ros::Duration((wall - last_).toSec());
  last_ = wall;
  if (jumps_.exchange(false) && now_ - kJump > kEarliest) now_ -= kJump;
  rosgraph_msgs::Clock message;
  message.clock = now_;
  clock_.publish(message);
}

}  // namespace organ_collision::stress
