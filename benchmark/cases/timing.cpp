#include "timing.hpp"

#include <algorithm>

namespace organ_collision::bench {

double Durations::quantile(double share) const {
  if (seconds_.empty()) return 0.0;
  std::vector<double> sorted = seconds_;
  const auto place = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5);
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(place),
                   sorted.end());
  return sorted[place];
}

}  // namespace organ_collision::bench
