#include "counters.hpp"

namespace organ_collision {

double EventRate::take(Time now) {
  const double seconds = std::chrono::duration<double>(now - since_).count();
  const double rate = seconds > 0.0 ? static_cast<double>(count_) / seconds : 0.0;
  since_ = now;
  count_ = 0;
  return rate;
}

}  // namespace organ_collision
