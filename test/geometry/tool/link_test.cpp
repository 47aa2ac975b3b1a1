#include "organ_collision/geometry/tool/link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/distance/closest_points.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

TEST(OrientedBox, SupportValueIsThatOfItsFarthestCorner) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Isometry3d pose = oracle::random_pose(0.3, random);
    const OrientedBox box{pose.translation(), pose.linear(),
                          Vector3d(random.uniform(0.0, 0.2), random.scale(1e-6, 0.2), 0.1)};
    const Vector3d direction = random.scale(1e-3, 1e3) * random.direction();
    double farthest = -INFINITY;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d signs(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0,
                           corner & 4 ? 1.0 : -1.0);
      farthest = std::max(farthest, direction.dot(pose * box.half_size.cwiseProduct(signs)));
    }
    EXPECT_NEAR(box.support_value(direction), farthest, 1e-15 * direction.norm());
  }
}

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

INSTANTIATE_TEST_SUITE_P(Kinds, ConvexCoreOf, testing::Range<std::size_t>(0, oracle::kCoreKinds));

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

/// [m] The distance of a centred shape, with its axes along x, y and z, from a point in its frame.
double box_distance(const Vector3d& size, const Vector3d& point) {
  return (point.cwiseAbs() - 0.5 * size).cwiseMax(0.0).norm();
}
double cylinder_distance(double radius, double length, const Vector3d& point) {
  return std::hypot(std::max(0.0, point.head<2>().norm() - radius),
                    std::max(0.0, std::abs(point.z()) - 0.5 * length));
}

double distance(const LinkPart& part, const Vector3d& point) {
  return closest_points(part.core, Triangle{point, point, point}).distance;
}

/// A point in or around a shape of this size, in its frame.
Vector3d around(const Vector3d& size, Random& random) {
  return size.cwiseProduct(random.point(1.2));
}

/// Checks that the part's bounds contain its core and touch it on all six sides.
void expect_tight_bounds(const LinkPart& part) {
  const OrientedBox& box = part.bounds;
  EXPECT_LE((box.axes * box.axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_GT(box.axes.determinant(), 0.0);
  for (int i = 0; i < 3; ++i) {
    const Vector3d axis = box.axes.col(i);
    const double middle = axis.dot(box.center);
    EXPECT_NEAR(part.project_onto(axis).high, middle + box.half_size[i], 1e-15);
    EXPECT_NEAR(part.project_onto(-axis).high, box.half_size[i] - middle, 1e-15);
  }
}

TEST(LinkPart, CylinderIsAlongZAndFlatEnded) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Isometry3d pose = oracle::random_pose(0.1, random);
    const double radius = random.scale(1e-4, 0.1), length = random.scale(1e-4, 0.3);
    const LinkPart part = LinkPart::cylinder(pose, radius, length);
    EXPECT_EQ(part.radius, tolerance::kConvexMargin);
    EXPECT_EQ(part.surface, nullptr);
    EXPECT_TRUE(part.core.is_cylinder());
    expect_tight_bounds(part);
    for (int k = 0; k < 20; ++k) {
      const Vector3d point = around({2.0 * radius, 2.0 * radius, length}, random);
      EXPECT_NEAR(distance(part, pose * point), cylinder_distance(radius, length, point), 1e-11);
    }
  }
}

TEST(LinkPart, BoxIsCentredWithItsSizesAlongItsAxes) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Isometry3d pose = oracle::random_pose(0.1, random);
    const Vector3d size(random.scale(1e-4, 0.3), random.scale(1e-4, 0.3), random.scale(1e-4, 0.3));
    const LinkPart part = LinkPart::box(pose, size);
    EXPECT_EQ(part.radius, tolerance::kConvexMargin);
    EXPECT_EQ(part.surface, nullptr);
    EXPECT_EQ(part.core.count, 8U);
    EXPECT_FALSE(part.core.is_cylinder());
    expect_tight_bounds(part);
    for (int k = 0; k < 20; ++k) {
      const Vector3d point = around(size, random);
      EXPECT_NEAR(distance(part, pose * point), box_distance(size, point), 1e-12);
    }
  }
}

}  // namespace
}  // namespace organ_collision
