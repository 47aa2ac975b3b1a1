#include "stamp_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace organ_collision {
namespace {

// [s]
constexpr double kArrival = 2.0;
/// Legal stamps are ahead of a /clock that ticks rarely.
constexpr double kMostAhead = 0.25;
/// Clocks of several hosts differ by less.
constexpr double kShortestJump = 0.02;
constexpr double kAnything = std::numeric_limits<double>::infinity();

}  // namespace

void StampOrder::add(const ClockJump& jump) {
  const double from = jump.from.toSec(), to = jump.to.toSec();
  if (from - to < kShortestJump) {
    if (era_ == Era::kNow) start(kAnything, Era::kUnknown);
    return;
  }
  const double middle = 0.5 * (from + to);
  // The transforms may have come before the /clock that goes with them.
  const bool has_stepped_back = std::exchange(stepped_from_, 0.0) > middle && latest_ < middle;
  start(std::min(middle - to, kMostAhead), has_stepped_back ? Era::kNow : Era::kUnknown);
}

void StampOrder::start(double most_ahead, Era era) {
  most_ahead_ = most_ahead;
  era_ = era;
  has_begun_ = false;
}

StampOrder::Verdict StampOrder::judge(ros::Time stamp, ros::Time now) {
  const double ahead = stamp.toSec() - now.toSec();
  const double before = std::exchange(latest_, stamp.toSec());
  const bool back = steps_back(before, ahead);
  was_ahead_ = ahead > 0.0;
  if (era_ == Era::kNow) {
    if (latest_ < before) stepped_from_ = before;
    return Verdict::kTake;
  }
  if (!std::exchange(has_begun_, true)) settled_ = now.toSec() + kArrival;
  const bool was_refused = era_ == Era::kBeforeJump;
  if (back || now.toSec() >= settled_) {
    era_ = Era::kNow;
  } else if (ahead > most_ahead_) {
    era_ = Era::kBeforeJump;
  } else if (ahead <= 0.0) {
    era_ = Era::kUnknown;
  }
  if (era_ == Era::kBeforeJump) return Verdict::kRefuse;
  return back || was_refused ? Verdict::kTakeAnew : Verdict::kTake;
}

/// Whether the stamps step back to the time of the clock. After a jump of 20 ms or more, it does
/// not matter by how much if the one before was ahead of the clock.
bool StampOrder::steps_back(double before, double ahead) const {
  if (std::isinf(most_ahead_)) return latest_ < before - kShortestJump;
  return ahead <= most_ahead_ && latest_ < before - (was_ahead_ ? 0.0 : most_ahead_);
}

}  // namespace organ_collision
