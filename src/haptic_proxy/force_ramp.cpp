#include "force_ramp.hpp"

#include <algorithm>

namespace organ_collision {

double ForceRamp::turn(Time now, double direction) {
  const double seconds = std::chrono::duration<double>(now - last_).count();
  share_ = std::clamp(share_ + direction_ * seconds / kDuration, 0.0, 1.0);
  direction_ = direction;
  last_ = now;
  return share_;
}

}  // namespace organ_collision
