#include "geometry/sides/wide_integer.hpp"

#include <CGAL/Gmpz.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

namespace organ_collision {
namespace {

constexpr std::size_t kLimbs = 6;
using Wide = WideInteger<kLimbs>;
using Exact = CGAL::Gmpz;
using Random = std::mt19937_64;

Exact power_of_two(int exponent) { return Exact(1) << static_cast<unsigned long>(exponent); }

/// The same number twice.
struct Number {
  Wide wide;
  Exact exact;
};

/// The sum of a few shifted numbers, with up to `bits` bits.
Number random_number(int bits, Random& random) {
  Number number{Wide(), Exact(0)};
  for (int i = static_cast<int>(random() % 4); i >= 0; --i) {
    const int digits = std::min(bits - 3, 1 + static_cast<int>(random() % 62));
    const auto part =
        static_cast<std::int64_t>(random() >> (64 - digits)) * (random() % 2 ? 1 : -1);
    const int shift = static_cast<int>(random() % static_cast<unsigned>(bits - 2 - digits));
    number.wide = number.wide + Wide(part, shift);
    number.exact += Exact(std::to_string(part)) * power_of_two(shift);
  }
  return number;
}

void expect_equal(const Wide& wide, const Exact& exact) {
  ASSERT_EQ(wide.sign(), static_cast<int>(CGAL::sign(exact)));
  const auto rounded = wide.rounded();
  ASSERT_NEAR(std::ldexp(rounded.mantissa, rounded.exponent), exact.to_double(),
              1e-15 * std::abs(exact.to_double()));
}

TEST(WideInteger, SumsDifferencesAndProductsAreExact) {
  Random random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const Number a = random_number(120, random), b = random_number(120, random);
    const Number c = random_number(120, random);
    expect_equal(a.wide + b.wide, a.exact + b.exact);
    expect_equal(a.wide - b.wide, a.exact - b.exact);
    expect_equal(-a.wide, -a.exact);
    expect_equal(a.wide * b.wide * c.wide, a.exact * b.exact * c.exact);
    // Everything cancels if every digit is right.
    EXPECT_EQ(((a.wide + b.wide) * c.wide - a.wide * c.wide - c.wide * b.wide).sign(), 0);
    EXPECT_EQ(((a.wide + b.wide) * (a.wide - b.wide) - a.wide * a.wide + b.wide * b.wide).sign(),
              0);
  }
}

TEST(WideInteger, ShiftsAreProductsWithPowersOfTwo) {
  for (const std::int64_t number : {std::int64_t{1}, std::int64_t{-1}, std::int64_t{-5},
                                    std::int64_t{1} << 53, -(std::int64_t{1} << 53) + 1}) {
    for (int shift = 0; shift < 320; ++shift) {
      const Wide shifted(number, shift);
      expect_equal(shifted, Exact(std::to_string(number)) * power_of_two(shift));
      EXPECT_EQ((shifted - Wide(number) * Wide(1, shift)).sign(), 0) << number << " << " << shift;
    }
  }
}

TEST(WideInteger, TheSignOfASingleDigit) {
  for (int shift = 0; shift < 383; ++shift) {
    EXPECT_EQ(Wide(1, shift).sign(), 1);
    EXPECT_EQ(Wide(-1, shift).sign(), -1);
  }
  EXPECT_EQ(Wide().sign(), 0);
}

TEST(Divide, QuotientAndRemainder) {
  Random random(2);
  for (int trial = 0; trial < 20000; ++trial) {
    Number below = random_number(1 + static_cast<int>(random() % 300) + 3, random);
    if (below.wide.sign() == 0) continue;
    if (below.wide.sign() < 0) below = {-below.wide, -below.exact};
    const auto quotient = static_cast<std::int64_t>(random() >> (1 + random() % 62));
    // The extreme remainders, and some between.
    const Wide wide = Wide(quotient) * below.wide;
    const Wide last = below.wide - Wide(1);
    const Wide small(static_cast<std::int64_t>(random() % 100));
    for (const Wide& remainder : {Wide(), last, (small - last).sign() < 0 ? small : last}) {
      const auto division = divide(wide + remainder, below.wide);
      ASSERT_EQ(division.quotient, quotient);
      ASSERT_EQ((division.remainder - remainder).sign(), 0);
    }
  }
}

TEST(Ratio, IsTheQuotientRoundedTwice) {
  Random random(3);
  for (int trial = 0; trial < 20000; ++trial) {
    const Number above = random_number(310, random);
    Number below = random_number(310, random);
    if (below.wide.sign() == 0) continue;
    if (below.wide.sign() < 0) below = {-below.wide, -below.exact};
    const double expected = above.exact.to_double() / below.exact.to_double();
    ASSERT_NEAR(ratio(above.wide, below.wide), expected, 4e-16 * std::abs(expected));
    ASSERT_EQ(ratio(below.wide, below.wide), 1.0);
    ASSERT_LE(ratio(below.wide - Wide(1), below.wide), 1.0);
  }
}

TEST(Ratio, EqualFractionsAreEqual) {
  Random random(4);
  for (int trial = 0; trial < 20000; ++trial) {
    const auto below = static_cast<std::int64_t>(random() >> (10 + random() % 50)) + 1;
    const auto above = static_cast<std::int64_t>(random() >> (10 + random() % 50));
    const Wide factor(static_cast<std::int64_t>(random() >> 8) + 1,
                      static_cast<int>(random() % 100));
    ASSERT_EQ(ratio(Wide(above) * factor, Wide(below) * factor), ratio(Wide(above), Wide(below)))
        << above << " / " << below;
  }
  EXPECT_EQ(ratio(Wide(), Wide(7)), 0.0);
  EXPECT_EQ(ratio(Wide(-3), Wide(4)), -0.75);
}

}  // namespace
}  // namespace organ_collision
