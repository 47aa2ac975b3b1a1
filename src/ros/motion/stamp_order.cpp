#include "stamp_order.hpp"

#include <algorithm>
#include <utility>

namespace organ_collision {
namespace {

// [s]
constexpr double kArrival = 2.0;
/// Legal stamps are ahead of a /clock that ticks rarely.
constexpr double kMostAhead = 0.25;
/// Clocks of several hosts differ by less.
constexpr double kShortestJump = 0.02;

/// [steps] No more: the stamps of a frame with two senders may step back again and again.
constexpr int kMostSteps = 3;

}  // namespace

bool is_small(const ClockJump& jump) { return jump.from.toSec() - jump.to.toSec() < kShortestJump; }

void StampOrder::add(const ClockJump& jump) {
  if (is_small(jump)) {
    if (era_ != Era::kNow) return;
    steps_to_watch_ = kMostSteps;
    has_begun_ = false;
    return;
  }
  const double to = jump.to.toSec(), middle = 0.5 * (jump.from.toSec() + to);
  // The transforms may have come before the /clock that goes with them.
  const bool has_stepped_back = std::exchange(stepped_from_, 0.0) > middle && latest_ < middle;
  era_ = has_stepped_back ? Era::kNow : Era::kUnknown;
  most_ahead_ = std::min(middle - to, kMostAhead);
  steps_to_watch_ = kMostSteps;
  has_begun_ = false;
}

StampOrder::Verdict StampOrder::judge(ros::Time stamp, ros::Time now) {
  const double ahead = stamp.toSec() - now.toSec();
  const double before = std::exchange(latest_, stamp.toSec());
  const bool back = steps_back(before, ahead);
  was_ahead_ = ahead > 0.0;
  if (!std::exchange(has_begun_, true)) settled_ = now.toSec() + kArrival;
  const bool is_settled = now.toSec() >= settled_;
  if (era_ == Era::kNow) {
    if (latest_ < before) stepped_from_ = before;
    if (is_settled) steps_to_watch_ = 0;
    const bool steps_far = steps_to_watch_ > 0 && latest_ < before - kShortestJump;
    if (steps_far) --steps_to_watch_;
    return steps_far ? Verdict::kTakeAnew : Verdict::kTake;
  }
  const bool was_refused = era_ == Era::kBeforeJump;
  if (back || is_settled) {
    era_ = Era::kNow;
  } else if (ahead > most_ahead_) {
    era_ = Era::kBeforeJump;
  } else if (ahead <= 0.0) {
    era_ = Era::kUnknown;
  }
  if (era_ == Era::kBeforeJump) return Verdict::kRefuse;
  return back || was_refused ? Verdict::kTakeAnew : Verdict::kTake;
}

/// Whether the stamps step back to the time of the clock. By how much does not matter if the one
/// before was ahead of the clock.
bool StampOrder::steps_back(double before, double ahead) const {
  return ahead <= most_ahead_ && latest_ < before - (was_ahead_ ? 0.0 : most_ahead_);
}

}  // namespace organ_collision
