#include "geometry/sides/exact_integer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

namespace organ_collision {
namespace {

using Random = std::mt19937_64;

/// A positive number with any number of digits up to `bits`.
ExactInteger random_number(unsigned bits, Random& random) {
  ExactInteger number = 0;
  for (unsigned i = 0; i < bits; i += 64) number = (number << 64) + random();
  return (number >> static_cast<unsigned>(random() % bits)) + 1;
}

TEST(Ratio, IsTheQuotientRoundedTwice) {
  Random random(3);
  for (int trial = 0; trial < 20000; ++trial) {
    const ExactInteger above = random_number(320, random), below = random_number(320, random);
    // The conversion of an integer may be wrong in the last digit.
    const double expected = static_cast<double>(above) / static_cast<double>(below);
    EXPECT_NEAR(ratio(above, below), expected, 1e-15 * expected);
    EXPECT_EQ(ratio(-above, below), -ratio(above, below));
    EXPECT_EQ(ratio(below, below), 1.0);
    EXPECT_LE(ratio(below - 1, below), 1.0);
  }
}

TEST(Ratio, EqualFractionsAreEqual) {
  Random random(4);
  for (int trial = 0; trial < 20000; ++trial) {
    const ExactInteger below = random_number(64, random), above = random_number(64, random);
    const ExactInteger factor = random_number(200, random);
    EXPECT_EQ(ratio(above * factor, below * factor), ratio(above, below))
        << above << " / " << below;
  }
}

TEST(Ratio, OfSimpleFractions) {
  EXPECT_EQ(ratio(0, 7), 0.0);
  EXPECT_EQ(ratio(-3, 4), -0.75);
  EXPECT_EQ(ratio(1, 3), 1.0 / 3.0);
  const ExactInteger large = ExactInteger(1) << 3300;
  EXPECT_EQ(ratio(3 * large, large), 3.0);
  EXPECT_EQ(ratio(1, large), 0.0);
}

}  // namespace
}  // namespace organ_collision
