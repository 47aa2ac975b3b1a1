#include "picking/volumes/conservative_volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "geometry/distance/closest_points.hpp"
#include "random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector2d;

double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

std::vector<Vector2d> corners_of(const std::array<Vector2d, 4>& points) {
  const ConvexHull hull = convex_hull(points);
  return {hull.begin(), hull.end()};
}

TEST(ConvexHull, ContainsAllPointsAndTurnsLeft) {
  std::mt19937 engine(51);
  for (int i = 0; i < 20'000; ++i) {
    // Points on a coarse grid, so that some coincide and some lie on a line.
    std::uniform_int_distribution<int> coordinate(0, 1 + i % 9);
    std::array<Vector2d, 4> points;
    for (Vector2d& point : points) point = {coordinate(engine), coordinate(engine)};
    const std::vector<Vector2d> corners = corners_of(points);
    ASSERT_FALSE(corners.empty());
    for (std::size_t k = 0; k < corners.size(); ++k) {
      EXPECT_NE(std::find(points.begin(), points.end(), corners[k]), points.end());
      const Vector2d& next = corners[(k + 1) % corners.size()];
      for (const Vector2d& point : points) EXPECT_GE(turn(corners[k], next, point), 0);
      if (corners.size() > 2) {
        EXPECT_GT(turn(corners[k], next, corners[(k + 2) % corners.size()]), 0);
      }
    }
    std::reverse(points.begin(), points.end());
    EXPECT_EQ(corners_of(points), corners);
  }
}

TEST(ConvexHull, OfASegmentAndAPoint) {
  const Vector2d a(0.25, 0.75), b(0.5, -0.25);
  EXPECT_EQ(corners_of({b, a, a, b}), (std::vector<Vector2d>{a, b}));
  EXPECT_EQ(corners_of({a, (a + b) / 2, b, b}), (std::vector<Vector2d>{a, b}));
  EXPECT_EQ(corners_of({b, b, b, b}), (std::vector<Vector2d>{b}));
}

using Eigen::Vector3d;

// If a half-space contains the balls around the four ends of the axis, it contains the capsules
// around all positions of the axis: their points are convex combinations of points of those balls.
TEST(ConservativeVolume, ContainsTheSweptCapsule) {
  Random random(15);
  int cameras[2] = {0, 0};
  for (int i = 0; i < 400'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const double offset = i % 2 == 0 ? 0.3 : random.magnitude(1, 1000);
    const ShaftMotion motion = random_motion(kind, offset, random);
    const double radius = random.magnitude(0.0005, 0.01);
    VolumeMargin margin;
    if (i % 3 == 0) margin.motion = random.magnitude(1e-9, 0.01);
    if (i % 5 == 0) margin.extent = random.magnitude(0.1, 1000);
    const ViewingVolume volume = conservative_volume(motion, radius, margin);
    ASSERT_TRUE(volume.clip().allFinite()) << motion;
    for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
      ASSERT_NEAR(volume.half_space(k).normal.norm(), 1, 1e-9) << motion;
    }
    const double thick = radius + margin.motion;
    for (const Vector3d& end :
         {motion.start.trocar, motion.start.tip, motion.end.trocar, motion.end.tip}) {
      ASSERT_LE(excess(volume, end) + thick, -2.5e-7 * margin.extent)
          << motion << " radius " << radius << " motion " << margin.motion << " extent "
          << margin.extent;
    }
    const bool perspective = volume.clip().row(3).head<3>().norm() > 0;
    ++cameras[perspective ? 1 : 0];
  }
  EXPECT_GT(cameras[0], 50'000);
  EXPECT_GT(cameras[1], 50'000);
}

// The volume exceeds the capsule at the corners of a box, and where a side of a wedge meets the far
// plane at a small angle.
TEST(ConservativeVolume, TakesInLittleMoreThanTheSweptCapsule) {
  Random random(16);
  int inside = 0;
  for (int i = 0; i < 20'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const ShaftMotion motion = random_motion(kind, 0.3, random);
    if (motion.start.trocar != motion.end.trocar) continue;
    const double radius = random.magnitude(0.0005, 0.01);
    const ViewingVolume volume = conservative_volume(motion, radius, {});
    const bool perspective = volume.clip().row(3).head<3>().norm() > 0;
    const Triangle swept = {motion.start.trocar, motion.start.tip, motion.end.tip};
    for (int k = 0; k < 50; ++k) {
      const Vector3d point = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1)) +
                             radius * random.magnitude(0.5, 20) * random.direction();
      if (excess(volume, point) > 0) continue;
      ++inside;
      const double distance = closest_points(ShaftAxis{point, point}, swept).distance;
      EXPECT_LT(distance, radius * (perspective ? 6 : 1.75)) << motion << "radius " << radius;
    }
  }
  EXPECT_GT(inside, 50'000);
}

TEST(ToolVolume, IsTheConservativeOneWithoutGrowth) {
  Random random(17);
  for (int i = 0; i < 50'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const ShaftMotion motion = random_motion(kind, 0.3, random);
    const double radius = random.magnitude(0.0005, 0.01);
    const ViewingVolume volume = tool_volume(motion, radius);
    double tightest = -1;
    for (const Vector3d& end :
         {motion.start.trocar, motion.start.tip, motion.end.trocar, motion.end.tip}) {
      const double out = excess(volume, end) + radius;
      ASSERT_LE(out, 1e-12) << motion << "radius " << radius;
      tightest = std::max(tightest, out);
    }
    EXPECT_GE(tightest, -1e-12) << "some plane touches the capsule" << motion;
  }
}

/// [m] The largest excess of a corner of a moving box at `time`.
double excess(const ViewingVolume& volume, const MovingBox& moving, double time) {
  const Eigen::Isometry3d pose = moving.motion().at(time);
  double largest = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d place(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Vector3d in_link =
        moving.box.center + moving.box.axes * place.cwiseProduct(moving.box.half_size);
    largest = std::max(largest, excess(volume, pose * in_link));
  }
  return largest;
}

TEST(ConservativeVolume, ContainsAMovingBox) {
  Random random(18);
  for (int i = 0; i < 20'000; ++i) {
    const MovingBox moving = random_box(i % 2 == 0 ? 0.3 : random.magnitude(1, 1000), random);
    VolumeMargin margin;
    if (i % 3 == 0) margin.motion = random.magnitude(1e-9, 0.01);
    if (i % 5 == 0) margin.extent = random.magnitude(0.1, 1000);
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    const ViewingVolume volume = conservative_volume(swept, margin);
    ASSERT_TRUE(volume.clip().allFinite()) << moving;
    EXPECT_EQ(volume.user_plane_count(), 0U);
    for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
      ASSERT_NEAR(volume.half_space(k).normal.norm(), 1, 1e-9) << moving;
    }
    for (int k = 0; k < 10; ++k) {
      const double out = excess(volume, moving, k < 2 ? k : random.uniform(0, 1));
      ASSERT_LE(out + moving.radius + margin.motion, -2.5e-7 * margin.extent + 1e-12) << moving;
    }
  }
}

TEST(ToolVolume, OfABoxIsTheBox) {
  Random random(19);
  for (int i = 0; i < 20'000; ++i) {
    MovingBox moving = random_box(0.3, random);
    const bool turns = moving.motion().angle() > 1e-8;
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    const ViewingVolume volume = tool_volume(swept);
    const double out = std::max(excess(volume, moving, 0), excess(volume, moving, 1));
    ASSERT_LE(out + moving.radius, 1e-12) << moving;
    if (turns) continue;
    EXPECT_NEAR(out + moving.radius, 0, 1e-12) << "its sides touch the box" << moving;
    for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
      const HalfSpace side = volume.half_space(k);
      const Vector3d along = swept.axes().transpose() * side.normal;
      EXPECT_NEAR(along.cwiseAbs().maxCoeff(), 1, 1e-12) << "along the box's own axes";
    }
  }
}

}  // namespace

}  // namespace organ_collision
