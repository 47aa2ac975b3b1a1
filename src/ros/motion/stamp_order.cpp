#include "stamp_order.hpp"

#include <algorithm>
#include <utility>

namespace organ_collision {
namespace {

// [s]
constexpr double kArrival = 2.0;
/// Legal stamps may be ahead of a /clock that ticks rarely.
constexpr double kAhead = 0.1;

}  // namespace

void StampOrder::add(const ClockJump& jump) {
  era_ = Era::kUnknown;
  arrived_ = jump.to.toSec() + kArrival;
  ahead_ = std::min(0.5 * (jump.from.toSec() - jump.to.toSec()), kAhead);
}

StampOrder::Verdict StampOrder::judge(ros::Time stamp, ros::Time now) {
  const double before = std::exchange(latest_, stamp.toSec());
  const double ahead_of_clock = latest_ - now.toSec();
  const bool has_all_arrived = now.toSec() >= arrived_;
  const bool steps_back = !has_all_arrived && latest_ < before - ahead_;
  const bool was_refused = era_ == Era::kBeforeJump;
  if (steps_back || has_all_arrived) {
    era_ = Era::kNow;
  } else if (era_ == Era::kUnknown && ahead_of_clock > ahead_) {
    era_ = Era::kBeforeJump;
  } else if (was_refused && ahead_of_clock <= 0.0) {
    era_ = Era::kUnknown;
  }
  if (era_ == Era::kBeforeJump) return Verdict::kRefuse;
  return steps_back || was_refused ? Verdict::kTakeAnew : Verdict::kTake;
}

}  // namespace organ_collision
