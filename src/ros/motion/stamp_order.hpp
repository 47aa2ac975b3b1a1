#pragma once

#include <ros/time.h>

namespace organ_collision {

/// A jump back of the clock, as the node noticed it.
struct ClockJump {
  ros::Time from, to;
};

/// Whether the clock jumped by less than 20 ms. Clocks of several hosts may differ by so much.
bool is_small(const ClockJump& jump);

/// The order in which the stamps of one frame's transforms come after a jump back of the clock.
///
/// Messages that were on their way during the jump arrive after it, with stamps of the time before.
/// To the new time they are poses of the future: TF would interpolate towards them. Where they end,
/// the frame's stamps step back to the time of the clock. After that, a stamp may be ahead of the
/// clock by anything: a node that was stopped gets many transforms before it gets the /clock that
/// goes with them.
class StampOrder {
 public:
  enum class Verdict {
    kTake,
    kRefuse,    ///< it seems to be of the time before the jump
    kTakeAnew,  ///< what was taken before it is of another time, or there is a gap between them
  };

  /// Notes that the clock jumped back. After a small jump, no stamp seems to be of the time before
  /// it. While stamps may still be of the time before a larger jump, a small one changes nothing.
  void add(const ClockJump& jump);
  /// What to do with the next transform. A stamp seems to be of the time before if it is ahead of
  /// the clock by more than 0.25 s (after a jump of less than 0.5 s: by more than half of it), and
  /// so do those that follow it, until the stamps step back or the clock has caught up with them.
  /// Stamps that step back by more than 20 ms later on are taken anew, up to three times: a node
  /// that was stopped sees several jumps of the clock as one, or only the end of one. All this ends
  /// 2 s of ROS time after the first transform that comes behind the jump. By then, all that was on
  /// its way should have arrived.
  Verdict judge(ros::Time stamp, ros::Time now);

 private:
  enum class Era { kUnknown, kBeforeJump, kNow };

  bool steps_back(double before, double ahead) const;

  // In seconds, because differences of ros::Time throw if they exceed 2^31 s.
  double latest_ = 0.0;        ///< the last stamp
  bool was_ahead_ = false;     ///< of the clock, when it came
  double stepped_from_ = 0.0;  ///< the stamp before the last step back that followed no jump
  double most_ahead_ = 0.0;    ///< by how much a stamp may be ahead of the clock
  int steps_to_watch_ = 0;     ///< how many more steps back are taken anew
  bool has_begun_ = false;     ///< a transform has come since the jump
  double settled_ = 0.0;       ///< 2 s after it
  Era era_ = Era::kNow;        ///< that of the last stamp
};

}  // namespace organ_collision
