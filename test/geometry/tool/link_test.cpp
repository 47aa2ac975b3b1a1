#include "organ_collision/geometry/tool/link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/distance/closest_points.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/core_distance_oracle.hpp"
#include "tool_meshes.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

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

TEST(LinkPart, SphereIsAllWithinItsRadius) {
  const Vector3d center(0.1, -0.2, 0.3);
  const LinkPart part = LinkPart::sphere(center, 0.04);
  EXPECT_EQ(part.radius, 0.04);
  EXPECT_EQ(part.surface, nullptr);
  EXPECT_EQ(part.core.count, 1U);
  EXPECT_EQ(part.core.points[0], center);
  expect_tight_bounds(part);
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

TEST(LinkPart, MeshHasItsSurfaceAndTheBoxAroundIt) {
  Random random(3);
  const ToolMesh mesh = scattered_mesh(40, random);
  const LinkPart part = LinkPart::mesh(mesh.surface());
  EXPECT_EQ(part.radius, tolerance::kConvexMargin);
  ASSERT_NE(part.surface, nullptr);
  EXPECT_EQ(part.surface->faces().size(), mesh.faces.size());
  EXPECT_EQ(part.bounds.center, part.surface->nodes().front().box.center);
  EXPECT_EQ(part.bounds.half_size, part.surface->nodes().front().box.half_size);
}

TEST(LinkPart, IsProjectedAsItsSurfaceOrCore) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const ToolMesh mesh =
        box_mesh(oracle::random_pose(0.1, random), {0.02, random.scale(1e-3, 0.1), 0.05});
    const LinkPart part = LinkPart::mesh(mesh.surface());
    const Vector3d direction = random.direction();
    double lowest = INFINITY, highest = -INFINITY;
    for (const Vector3d& vertex : mesh.vertices) {
      lowest = std::min(lowest, direction.dot(vertex));
      highest = std::max(highest, direction.dot(vertex));
    }
    EXPECT_NEAR(part.project_onto(direction).low, lowest, 1e-15);
    EXPECT_NEAR(part.project_onto(direction).high, highest, 1e-15);
    ConvexCore core = oracle::make_core(3, random);
    const LinkPart convex{core, nullptr, 0.01, {}};
    EXPECT_EQ(convex.project_onto(direction).low, -core.support_value(-direction));
    EXPECT_EQ(convex.project_onto(direction).high, core.support_value(direction));
  }
}

}  // namespace
}  // namespace organ_collision
