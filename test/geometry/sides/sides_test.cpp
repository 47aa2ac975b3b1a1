// Exact signs, and that crossings depend on nothing but the shapes. The proof of the placement
// compares crossings and sides, in special positions of all kinds, with exact arithmetic.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "geometry/sides/face_crossing.hpp"
#include "test/proof/exact_sides.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;
using Points = std::array<Vector3d, 6>;

/// A positive number with any number of digits up to `bits`.
ExactInteger random_number(unsigned bits, std::mt19937_64& random) {
  ExactInteger number = 0;
  for (unsigned i = 0; i < bits; i += 64) number = (number << 64) + random();
  return (number >> static_cast<unsigned>(random() % bits)) + 1;
}

TEST(Ratio, IsTheQuotientRoundedTwice) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20000; ++trial) {
    const ExactInteger above = random_number(320, random), below = random_number(320, random);
    // The conversion of an integer may be wrong in the last digit.
    const double expected = static_cast<double>(above) / static_cast<double>(below);
    EXPECT_NEAR(ratio(above, below), expected, 1e-15 * expected);
    EXPECT_EQ(ratio(-above, below), -ratio(above, below));
    EXPECT_EQ(ratio(below, below), 1.0);
    EXPECT_LE(ratio(below - 1, below), 1.0);
  }
  EXPECT_EQ(ratio(0, 7), 0.0);
  EXPECT_EQ(ratio(1, ExactInteger(1) << 3300), 0.0);
}

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

/// A face and an axis near it. Most are in special position.
struct SideTrial {
  Triangle face;
  ShaftAxis axis;
};

Vector3d grid_point(int most, Random& random) {
  return Vector3d(random.integer(-most, most), random.integer(-most, most),
                  random.integer(-most, most));
}

SideTrial make_side_trial(Random& random) {
  SideTrial trial;
  Triangle& face = trial.face;
  ShaftAxis& axis = trial.axis;
  if (random.chance(0.4)) {
    // Points on a coarse grid: most trials have an edge, a corner or an end in a special position,
    // and many faces are degenerate.
    const double spacing = std::ldexp(random.chance(0.5) ? 1.0 : 3.0, random.integer(-140, 15));
    for (Vector3d& corner : face) corner = spacing * grid_point(2, random);
    return {face, {spacing * grid_point(3, random), spacing * grid_point(3, random)}};
  }
  const Vector3d center = random.chance(0.2) ? random.point(1e5) : random.point(0.1);
  const double size = random.scale(1e-4, 0.1);
  for (Vector3d& corner : face) corner = oracle::rounded(center + size * random.direction());
  const double a = random.uniform(-0.2, 1.0), b = random.uniform(-0.2, 1.0);
  Vector3d aim = face[0] + a * (face[1] - face[0]) + b * (face[2] - face[0]);
  const int kind = random.integer(0, 3);
  if (kind == 1) aim = face[random.integer(0, 2)];
  if (kind == 2) aim = 0.5 * (face[0] + face[1]);  // exact for most vertices
  if (kind == 3) aim = face[1] + random.scale(1e-16, 1e-9) * random.direction();
  axis.trocar = oracle::rounded(aim + random.scale(1e-3, 1.0) * random.direction());
  const double beyond = random.chance(0.2) ? 1.0 : std::ldexp(1.0, random.integer(0, 4));
  axis.tip = axis.trocar + beyond * (aim - axis.trocar);
  if (random.chance(0.5)) std::swap(axis.trocar, axis.tip);
  return trial;
}

/// Nothing but the shape counts, not even in the last digit.
TEST(FaceCrossing, IsExactAndTheOrderOfCornersChangesNothing) {
  Random random(72);
  int crossed = 0, missed = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto [face, axis] = make_side_trial(random);
    const auto expected = oracle::exact_crossings({face}, axis);
    const int direction = crossing_direction(face, axis);
    ASSERT_EQ(direction, expected.empty() ? 0 : expected[0].direction) << "trial " << trial;
    ++(direction != 0 ? crossed : missed);
    const Triangle rotated = {face[1], face[2], face[0]}, turned = {face[2], face[1], face[0]};
    ASSERT_EQ(crossing_direction(rotated, axis), direction);
    ASSERT_EQ(crossing_direction(turned, axis), -direction);
    ASSERT_EQ(crossing_direction(face, {axis.tip, axis.trocar}), -direction);
    if (direction == 0) continue;
    const FaceCrossing one = face_crossing(face, axis);
    EXPECT_NEAR(one.shaft, expected[0].shaft, 1e-14) << "trial " << trial;
    EXPECT_LE((one.barycentric - expected[0].barycentric).norm(), 1e-14) << "trial " << trial;
    for (const Triangle& same : {rotated, turned}) {
      const FaceCrossing other = face_crossing(same, axis);
      ASSERT_EQ(other.shaft, one.shaft);
      ASSERT_EQ(other.shaft_rest, one.shaft_rest);
      ASSERT_EQ(crossing_shift(same, axis), crossing_shift(face, axis));
    }
    const Vector3d& bary = face_crossing(rotated, axis).barycentric;
    ASSERT_EQ(Vector3d(bary[2], bary[0], bary[1]), one.barycentric);
  }
  EXPECT_GT(crossed, 3000);
  EXPECT_GT(missed, 3000);
}

}  // namespace
}  // namespace organ_collision
