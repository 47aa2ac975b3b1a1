#pragma once

#include <ros/time.h>

namespace organ_collision {

/// A jump back of the clock, as the node noticed it.
struct ClockJump {
  ros::Time from, to;
};

/// The order in which the stamps of one frame's transforms come after a jump back of the clock.
///
/// Messages that were on their way during the jump arrive after it, with stamps of the time before.
/// To the new time they are poses of the future: TF would interpolate towards them. Where they end,
/// the frame's stamps step back, because messages of one sender do not overtake each other. After
/// that, a stamp may be ahead of the clock by anything: a node that was stopped gets many
/// transforms before it gets the /clock that goes with them.
class StampOrder {
 public:
  enum class Verdict {
    kTake,
    kRefuse,    ///< it is of the time before the jump
    kTakeAnew,  ///< what was taken before it is of another time, or there is a gap between them
  };

  /// Notes that the clock jumped back.
  void add(const ClockJump& jump);
  /// What to do with the next transform. A stamp is of the time before if it is ahead of the clock
  /// by more than 0.1 s, or by more than half of a shorter jump, and so are those that follow it,
  /// until the stamps step back by as much, or the clock has caught up. 2 s of ROS time after the
  /// jump, all that was on its way has arrived.
  Verdict judge(ros::Time stamp, ros::Time now);

 private:
  enum class Era { kUnknown, kBeforeJump, kNow };

  // In seconds, because differences of ros::Time throw if they exceed 2^31 s.
  double latest_ = 0.0;   ///< the last stamp
  double arrived_ = 0.0;  ///< when all that was on its way has arrived
  double ahead_ = 0.0;    ///< by how much a stamp may be ahead of the clock
  Era era_ = Era::kNow;   ///< that of the last stamp
};

}  // namespace organ_collision
