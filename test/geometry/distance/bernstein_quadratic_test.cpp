#include "geometry/distance/bernstein_quadratic.hpp"

#include <gtest/gtest.h>

#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

double value(const BernsteinQuadratic& q, double t) {
  return (1.0 - t) * (1.0 - t) * q.start + 2.0 * t * (1.0 - t) * q.middle + t * t * q.end;
}

TEST(BernsteinQuadratic, IsPositiveBeforeItsFirstRootAndZeroThere) {
  oracle::Random random(1);
  int roots = 0;
  for (int i = 0; i < 10'000; ++i) {
    const BernsteinQuadratic q{random.scale(1e-9, 1.0), random.sign() * random.scale(1e-9, 1.0),
                               random.sign() * random.scale(1e-9, 1.0)};
    const double root = first_root(q);
    if (root <= 1.0) {
      ++roots;
      EXPECT_GT(root, 0.0);
      EXPECT_NEAR(value(q, root), 0.0, 1e-15);
    } else {
      EXPECT_EQ(root, 2.0);
    }
    for (int step = 0; step < 50; ++step) {
      const double t = step / 50.0 * std::min(root, 1.0);
      EXPECT_GT(value(q, t), -1e-15) << q.start << " " << q.middle << " " << q.end << " at " << t;
    }
  }
  EXPECT_GT(roots, 1000);
}

TEST(BernsteinQuadratic, OfALinearFunction) {
  EXPECT_DOUBLE_EQ(first_root({1.0, 0.25, -0.5}), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(first_root({1.0, 0.5, 0.0}), 1.0);
  EXPECT_EQ(first_root({1.0, 1.5, 2.0}), 2.0);
}

// It falls below zero between positive ends, touches zero, and stays just above it.
TEST(BernsteinQuadratic, OfAParabola) {
  EXPECT_NEAR(first_root({1.0, -1.5, 1.0}), 0.5 - std::sqrt(0.05), 1e-15);
  EXPECT_DOUBLE_EQ(first_root({1.0, -1.0, 1.0}), 0.5);
  EXPECT_EQ(first_root({1.0, -0.999, 1.0}), 2.0);
}

}  // namespace
}  // namespace organ_collision
