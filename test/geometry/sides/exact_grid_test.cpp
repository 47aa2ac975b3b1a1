#include "geometry/sides/exact_grid.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "side_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// A number that is described wrongly changes the ratios.
void expect_same_ratios(const Vector3d& difference, const IntegerVector& integers) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (difference[k] == 0.0) {
        EXPECT_TRUE(integers[k].is_zero());
      } else {
        const int sign = integers[k].sign();
        EXPECT_DOUBLE_EQ(ratio(sign * integers[i], sign * integers[k]),
                         difference[i] / difference[k]);
      }
    }
  }
}

TEST(ExactGrid, DifferencesKeepTheirRatios) {
  Random random(51);
  for (int trial = 0; trial < 2000; ++trial) {
    const double size = random.scale(1e-12, 1e5);
    const Vector3d a = random.point(size), b = random.point(size), origin = Vector3d::Zero();
    const ExactGrid grid{a, b, origin};
    for (const auto& [from, to] : {std::pair{a, origin}, std::pair{origin, b}, std::pair{a, b}}) {
      expect_same_ratios(to - from, grid.difference(from, to));
    }
  }
}

TEST(ExactGrid, FromTheLargestToTheSmallestNumber) {
  const Vector3d large(1048575.9999999999, -1048575.0, 1e6), small(5e-324, 0.0, -1e-320);
  const Vector3d origin = Vector3d::Zero();
  const ExactGrid grid{large, small, origin};
  const IntegerVector tiny = grid.difference(origin, small);
  EXPECT_EQ(tiny[0], 1) << "the smallest number is one";
  expect_same_ratios(large, grid.difference(origin, large));
  const IntegerVector huge = grid.difference(large, small);
  EXPECT_TRUE(dot(huge, cross(huge, tiny)).is_zero());
  const ExactInteger product = huge[0] * huge[0] * huge[0];
  EXPECT_EQ(product / huge[0] / huge[0], huge[0]) << "no digit is lost";
}

}  // namespace
}  // namespace organ_collision
