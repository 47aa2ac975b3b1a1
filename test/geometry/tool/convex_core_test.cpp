#include "organ_collision/geometry/tool/convex_core.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "test/proof/core_distance_oracle.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// Points of a core's boundary: its corners, or `count` points on each of a cylinder's rims.
std::vector<Vector3d> border(const ConvexCore& core, int count) {
  std::vector<Vector3d> points(core.points.begin(), core.points.begin() + core.count);
  if (!core.is_cylinder()) return points;
  std::vector<Vector3d> rims;
  for (const Vector3d& center : points) {
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * M_PI * i / count;
      rims.push_back(center + core.rim * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
  }
  return rims;
}

Vector3d any_direction(const ConvexCore& core, Random& random) {
  // For some cores this is the axis.
  if (random.chance(0.2)) return core.points[core.count - 1] - core.points[0];
  if (random.chance(0.2)) return core.rim.col(0);
  return random.scale(1e-12, 1e6) * random.direction();
}

class ConvexCoreOf : public testing::TestWithParam<std::size_t> {};

TEST_P(ConvexCoreOf, SupportIsItsFarthestPoint) {
  Random random(10 + GetParam());
  for (int i = 0; i < 300; ++i) {
    const ConvexCore core = oracle::make_core(GetParam(), random);
    const Vector3d direction = any_direction(core, random);
    const Vector3d support = core.support(direction);
    EXPECT_LE(oracle::distance(core, support), 4e-15);
    EXPECT_EQ(core.support_value(direction), direction.dot(support));
    double highest = -INFINITY;
    for (const Vector3d& point : border(core, 5000)) {
      highest = std::max(highest, direction.dot(point));
    }
    const double rounding = 1e-15 * direction.norm();
    EXPECT_GE(core.support_value(direction), highest - rounding);
    // The nearest of 5000 points on a rim is at most this much lower.
    const double lower = 2e-7 * core.rim.norm() * direction.norm();
    EXPECT_LE(core.support_value(direction), highest + lower + rounding);
  }
}

TEST_P(ConvexCoreOf, MovesRigidly) {
  Random random(20 + GetParam());
  for (int i = 0; i < 300; ++i) {
    const ConvexCore core = oracle::make_core(GetParam(), random);
    const Eigen::Isometry3d pose = oracle::random_pose(0.3, random);
    const ConvexCore moved = pose * core;
    EXPECT_EQ(moved.count, core.count);
    EXPECT_EQ(moved.is_axis(), core.is_axis());
    EXPECT_EQ(moved.is_cylinder(), core.is_cylinder());
    const Vector3d direction = any_direction(core, random);
    EXPECT_NEAR(moved.support_value(pose.linear() * direction),
                core.support_value(direction) +
                    direction.dot(pose.linear().transpose() * pose.translation()),
                1e-15 * direction.norm());
  }
}

TEST_P(ConvexCoreOf, NoDirectionStillGivesOneOfItsPoints) {
  Random random(30 + GetParam());
  const ConvexCore core = oracle::make_core(GetParam(), random);
  EXPECT_LE(oracle::distance(core, core.support(Vector3d::Zero())), 4e-15);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ConvexCoreOf, testing::Range<std::size_t>(0, oracle::kCoreKinds));

TEST(ConvexCore, OfAShaftIsItsAxis) {
  const ShaftAxis axis{{0.1, 0.2, 0.3}, {0.4, -0.5, 0.6}};
  const ConvexCore core = axis;
  EXPECT_TRUE(core.is_axis());
  EXPECT_FALSE(core.is_cylinder());
  EXPECT_EQ(core.axis().trocar, axis.trocar);
  EXPECT_EQ(core.axis().tip, axis.tip);
}

TEST(ConvexCore, OfABallIsAnAxisWithoutLength) {
  const ConvexCore core = LinkPart::sphere({0.1, 0.2, 0.3}, 0.01).core;
  EXPECT_TRUE(core.is_axis());
  EXPECT_EQ(core.axis().trocar, core.axis().tip);
}

// is_cylinder() must not depend on which components of the rim are zero.
TEST(ConvexCore, OfACylinderIsOneInEveryOrientation) {
  Random random(3);
  for (int i = 0; i < 24; ++i) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (int turns = 0; turns < i; ++turns) {
      pose.rotate(Eigen::AngleAxisd(M_PI / 2, Vector3d(Vector3d::Unit(random.integer(0, 2)))));
    }
    for (double& element : pose.linear().reshaped()) element = std::round(element);
    const ConvexCore core = LinkPart::cylinder(pose, 0.01, 0.05).core;
    EXPECT_TRUE(core.is_cylinder());
    EXPECT_FALSE(core.is_axis());
  }
}

}  // namespace
}  // namespace organ_collision
