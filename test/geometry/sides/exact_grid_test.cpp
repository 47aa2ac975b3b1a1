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

std::size_t limbs_of(const ExactGrid& grid) {
  return grid.with_limbs([](auto limbs) { return decltype(limbs)::value; });
}

TEST(ExactGrid, DifferencesKeepTheirRatios) {
  Random random(51);
  int few = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double size = random.scale(1e-12, 1e5);
    const Vector3d a = random.point(size), b = random.point(size), origin = Vector3d::Zero();
    const ExactGrid grid{a, b, origin};
    few += limbs_of(grid) == 6;
    for (const auto& [from, to] : {std::pair{a, origin}, std::pair{origin, b}, std::pair{a, b}}) {
      grid.with_limbs([&, from = from, to = to](auto limbs) {
        constexpr std::size_t kLimbs = decltype(limbs)::value;
        expect_same_ratios<kLimbs>(to - from, grid.difference<kLimbs>(from, to));
      });
    }
  }
  EXPECT_GT(few, 1900) << "points of any size have few digits";
}

TEST(ExactGrid, FromTheLargestToTheSmallestNumber) {
  const Vector3d large(1048575.9999999999, -1048575.0, 1e6), small(5e-324, 0.0, -1e-320);
  const Vector3d origin = Vector3d::Zero(), noise(1e-18, 0.1, 0.2);
  const ExactGrid grid{large, small, origin};
  constexpr std::size_t kMany = 56;
  EXPECT_EQ(limbs_of(grid), kMany);
  EXPECT_EQ(limbs_of(ExactGrid{small, origin}), 6U);
  EXPECT_EQ(limbs_of(ExactGrid{noise, origin}), 12U);
  EXPECT_EQ(limbs_of(ExactGrid{origin}), 6U);
  const auto tiny = grid.difference<kMany>(origin, small);
  EXPECT_EQ((tiny[0] - WideInteger<kMany>(1)).sign(), 0) << "the smallest number is one";
  expect_same_ratios<kMany>(large, grid.difference<kMany>(origin, large));
  const auto huge = grid.difference<kMany>(large, small);
  EXPECT_EQ(dot(huge, cross(huge, tiny)).sign(), 0);
  // The largest triple product that there is.
  const auto product = huge[0] * huge[0] * huge[0];
  EXPECT_EQ(product.sign(), -1);
  EXPECT_EQ(ratio(WideInteger<kMany>() - product, WideInteger<kMany>() - product), 1.0);
}

}  // namespace
}  // namespace organ_collision
