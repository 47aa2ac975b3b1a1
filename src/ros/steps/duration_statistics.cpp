#include "duration_statistics.hpp"

#include <algorithm>
#include <vector>

namespace organ_collision {

DurationStatistics::Summary DurationStatistics::summary() const {
  const std::size_t kept = std::min(count_, kCapacity);
  if (kept == 0) return {};
  std::vector<double> sorted(seconds_.begin(), seconds_.begin() + kept);
  std::sort(sorted.begin(), sorted.end());
  const auto percentile = [&](std::size_t percent) {
    return sorted[(kept * percent + 99) / 100 - 1];
  };
  return {count_, percentile(50), percentile(99), sorted.back()};
}

}  // namespace organ_collision
