#include "geometry/sides/exact_signs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "side_trials.hpp"
#include "test/proof/exact_sides.hpp"

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

using Points = std::array<Vector3d, 6>;

int sign_of(const Points& p) {
  return triple_product_sign({p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]});
}

/// What rounding makes of it.
int rounded_sign_of(const Points& p) {
  const double value = (p[1] - p[0]).dot((p[3] - p[2]).cross(p[5] - p[4]));
  return (value > 0.0) - (value < 0.0);
}

/// Nearly coplanar points, in doubles.
Points nearly_coplanar(Random& random) {
  const Vector3d u = random.direction(), v = random.direction();
  const double size = random.scale(1e-3, 1e3), off = random.chance(0.5) ? 0.0 : 1e-16;
  Points points;
  for (Vector3d& point : points) {
    point = size * (random.uniform(-1, 1) * u + random.uniform(-1, 1) * v) +
            off * size * random.direction();
  }
  return points;
}

TEST(TripleProductSign, IsExactWhereDoublesAreNot) {
  Random random(31);
  int wrong_in_doubles = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Points points = nearly_coplanar(random);
    const int expected = oracle::exact_triple_sign(points);
    ASSERT_EQ(sign_of(points), expected) << "trial " << trial;
    if (rounded_sign_of(points) != expected) ++wrong_in_doubles;
  }
  EXPECT_GT(wrong_in_doubles, 500) << "the exact arithmetic was not needed";
}

TEST(TripleProductSign, ZeroIsZero) {
  Random random(32);
  for (int trial = 0; trial < 2000; ++trial) {
    const double spacing = std::ldexp(1.0, random.integer(-1074, 15));
    const Vector3d u = spacing * grid_point(3, random), v = spacing * grid_point(3, random);
    const Vector3d origin = spacing * grid_point(7, random);
    const int a = random.integer(-2, 2), b = random.integer(-2, 2);
    const Points points = {origin, origin + u, origin, origin + v, origin, origin + a * u + b * v};
    ASSERT_EQ(sign_of(points), 0) << "trial " << trial;
  }
}

/// The determinant of coordinates from the largest to the smallest ones. Its products underflow.
TEST(TripleProductSign, AllMagnitudes) {
  Random random(33);
  int positive = 0, zero = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    Points points;
    for (Vector3d& point : points) {
      for (double& coordinate : point) {
        coordinate = std::ldexp(random.uniform(-1, 1), random.integer(-1074, 19));
        if (random.chance(0.2)) coordinate = 0.0;
      }
    }
    if (random.chance(0.5)) points[4] = points[0];
    if (random.chance(0.5)) points[5] = points[3];
    const int expected = oracle::exact_triple_sign(points);
    ASSERT_EQ(sign_of(points), expected) << "trial " << trial;
    positive += expected > 0;
    zero += expected == 0;
  }
  EXPECT_GT(positive, 1000);
  EXPECT_LT(zero, 1000);
}

TEST(TripleProductSign, IsAntisymmetric) {
  Random random(34);
  for (int trial = 0; trial < 5000; ++trial) {
    const Points p = nearly_coplanar(random);
    const ExactVector u{p[0], p[1]}, v{p[2], p[3]}, w{p[4], p[5]}, back{p[3], p[2]};
    const int sign = triple_product_sign(u, v, w);
    ASSERT_EQ(triple_product_sign(v, u, w), -sign);
    ASSERT_EQ(triple_product_sign(w, u, v), sign);
    ASSERT_EQ(triple_product_sign(u, back, w), -sign);
  }
}

TEST(CrossProductSign, IsTheSignOfTheFirstComponentThatIsNotZero) {
  Random random(35);
  int first = 0, second = 0, third = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const double spacing = std::ldexp(1.0, random.integer(-1074, 15));
    const Vector3d a = grid_point(1, random), b = grid_point(1, random);
    const Vector3d c = grid_point(1, random), d = grid_point(1, random);
    const Vector3d product = (b - a).cross(d - c);  // exact
    int expected = 0;
    for (const double component : product) {
      if (expected == 0) expected = (component > 0.0) - (component < 0.0);
    }
    ASSERT_EQ(cross_product_sign({spacing * a, spacing * b}, {spacing * c, spacing * d}), expected)
        << "trial " << trial;
    if (product.x() != 0.0)
      ++first;
    else if (product.y() != 0.0)
      ++second;
    else if (product.z() != 0.0)
      ++third;
  }
  EXPECT_GT(std::min({first, second, third}), 100);
}

TEST(CrossProductSign, NearlyParallelVectors) {
  const Vector3d origin(0.1, 0.7, -0.3), along(0.3, 0.1, 0.9), to = origin + along;
  const Vector3d far = origin + 4.0 * (to - origin);  // exact: a power of two
  EXPECT_EQ(cross_product_sign({origin, to}, {to, origin}), 0);
  const Vector3d off(far.x(), std::nextafter(far.y(), 10.0), far.z());
  const int sign = cross_product_sign({origin, to}, {origin, off});
  EXPECT_NE(sign, 0);
  EXPECT_EQ(cross_product_sign({origin, off}, {origin, to}), -sign);
}

}  // namespace

}  // namespace organ_collision
