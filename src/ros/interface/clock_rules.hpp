#pragma once

#include <ros/time.h>

#include <string>

namespace organ_collision {

/// [s] Clocks of several hosts differ by less, and messages overtake each other by less. A clock
/// that goes back by more has jumped, for example because a simulator was reset.
inline constexpr double kClockTolerance = 0.02;

/// [s] How far a stamp may be ahead of the clock, unless the parameter max_ahead_sec says
/// otherwise.
inline constexpr double kMaxAheadDefault = 1.0;

/// Why a stamp is not believed: it is ahead of the clock by more than `max_ahead_sec`. Empty if it
/// is believed. Before simulated time begins (`now` is zero), every stamp is.
std::string ahead_fault(ros::Time stamp, ros::Time now, double max_ahead_sec);

/// Notices when ROS time jumps back.
class ClockWatch {
 public:
  /// Compares `now` with the latest time of the calls before. Returns true, and logs a warning, if
  /// it is earlier by more than kClockTolerance.
  bool has_jumped_back(ros::Time now);

 private:
  ros::Time latest_;
};

}  // namespace organ_collision
