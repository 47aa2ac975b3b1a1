#include "exact_grid.hpp"

#include <algorithm>

namespace organ_collision {

ExactGrid::ExactGrid(std::initializer_list<Eigen::Vector3d> points) {
  int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
  for (const Eigen::Vector3d& point : points) {
    for (const double coordinate : {point.x(), point.y(), point.z()}) {
      if (coordinate == 0.0) continue;
      int exponent;
      const auto digits =
          static_cast<std::int64_t>(kTwoToDigits * std::frexp(coordinate, &exponent));
      const int last_digit = std::ilogb(static_cast<double>(digits & -digits));
      lowest = std::min(lowest, exponent - kDigits + last_digit);
      highest = std::max(highest, exponent);
    }
  }
  if (lowest > highest) return;  // All points are the origin.
  exponent_ = lowest;
  digits_ = highest - lowest;
}

}  // namespace organ_collision
