#pragma once

#include <chrono>

namespace organ_collision {

/// The share of a force that is published. It rises and falls linearly in time, between 0 and 1
/// within kDuration, so that a force neither appears nor vanishes in a jump.
class ForceRamp {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// [s]
  static constexpr double kDuration = 0.01;

  /// From `now` on, the share rises or falls. Return the share at `now`.
  double rise(Time now) { return turn(now, 1.0); }
  double fall(Time now) { return turn(now, -1.0); }
  /// In [0, 1], at the time of the last call.
  double share() const { return share_; }

 private:
  double turn(Time now, double direction);

  double share_ = 0.0;
  double direction_ = -1.0;  ///< 1: it rises; -1: it falls
  Time last_{};
};

}  // namespace organ_collision
