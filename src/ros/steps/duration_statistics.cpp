#include "duration_statistics.hpp"

#include <algorithm>
#include <vector>

namespace organ_collision {

DurationStatistics::Summary DurationStatistics::summary() const {
  const std::size_t kept = std::min(count_, kCapacity);
  if (kept == 0) return {};
  std::vector<double> times(seconds_.begin(), seconds_.begin() + kept);
  const auto percentile = [&](std::size_t percent) {
    const auto place = times.begin() + static_cast<std::ptrdiff_t>((kept * percent + 99) / 100 - 1);
    std::nth_element(times.begin(), place, times.end());  // Sorting all would delay a step.
    return *place;
  };
  return {count_, percentile(50), percentile(99), *std::max_element(times.begin(), times.end())};
}

}  // namespace organ_collision
