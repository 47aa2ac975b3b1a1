#include "geometry/sides/exact_grid.hpp"

#include <gtest/gtest.h>

#include "side_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// A number that `digits` or `last_digit` describe wrongly changes the ratios.
template <std::size_t kLimbs>
void expect_same_ratios(const Vector3d& difference, const WideVector<kLimbs>& integers) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (difference[k] == 0.0) {
        EXPECT_EQ(integers[k].sign(), 0);
      } else {
        const bool is_negative = integers[k].sign() < 0;
        EXPECT_DOUBLE_EQ(
            is_negative ? ratio(-integers[i], -integers[k]) : ratio(integers[i], integers[k]),
            difference[i] / difference[k]);
      }
    }
  }
}

TEST(ExactGrid, DifferencesKeepTheirRatios) {
  Random random(51);
  int coarse = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double size = random.scale(1e-12, 1e5);
    const Vector3d a = random.point(size), b = random.point(size), origin = Vector3d::Zero();
    const ExactGrid grid{a, b, origin};
    coarse += grid.is_coarse();
    for (const auto& [from, to] : {std::pair{a, origin}, std::pair{origin, b}, std::pair{a, b}}) {
      expect_same_ratios<ExactGrid::kManyLimbs>(to - from,
                                                grid.difference<ExactGrid::kManyLimbs>(from, to));
      if (!grid.is_coarse()) continue;
      expect_same_ratios<ExactGrid::kFewLimbs>(to - from,
                                               grid.difference<ExactGrid::kFewLimbs>(from, to));
    }
  }
  EXPECT_GT(coarse, 1900) << "points of any size have few digits";
}

TEST(ExactGrid, FromTheLargestToTheSmallestNumber) {
  const Vector3d large(1048575.9999999999, -1048575.0, 1e6), small(5e-324, 0.0, -1e-320);
  const Vector3d origin = Vector3d::Zero();
  const ExactGrid grid{large, small, origin};
  EXPECT_FALSE(grid.is_coarse());
  constexpr std::size_t kMany = ExactGrid::kManyLimbs;
  const auto integers = grid.difference<kMany>(origin, small);
  EXPECT_EQ((integers[0] - WideInteger<kMany>(1)).sign(), 0) << "the smallest number is one";
  expect_same_ratios<kMany>(large, grid.difference<kMany>(origin, large));
  const auto tiny = grid.difference<kMany>(origin, small),
             huge = grid.difference<kMany>(large, small);
  const WideInteger<kMany> square = dot(huge, cross(huge, tiny));
  EXPECT_EQ(square.sign(), 0);
  EXPECT_NE(dot(tiny, cross(huge, {tiny[2], tiny[0], tiny[1]})).sign(), 0);
  EXPECT_TRUE((ExactGrid{small, origin}).is_coarse());
  EXPECT_TRUE((ExactGrid{origin}).is_coarse());
}

}  // namespace
}  // namespace organ_collision
