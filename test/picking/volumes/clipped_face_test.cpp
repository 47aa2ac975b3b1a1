#include "picking/volumes/clipped_face.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "picking/volumes/conservative_volume.hpp"
#include "test/picking/volumes/clip_oracle.hpp"
#include "test/picking/volumes/random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d area(const Polygon& polygon) {
  Vector3d twice = Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return twice / 2;
}

// [m] The largest distance from a corner of `from` to the nearest corner of `to`.
double farthest_corner(const Polygon& from, const Polygon& to) {
  double farthest = 0;
  for (const Vector3d& corner : from) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3d& other : to) nearest = std::min(nearest, (corner - other).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

/// A face whose middle is up to 1 cm from the tool's axis.
Triangle random_face(const ShaftMotion& motion, Random& random) {
  Triangle face;
  for (Vector3d& corner : face) {
    corner = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1)) + 0.01 * random.direction() +
             random.uniform(0.001, 0.05) * random.direction();
  }
  return face;
}

ConvexPolygon part_of(const Triangle& face, const ViewingVolume& volume) {
  return clipped(shifted(face, volume.origin()), volume);
}

TEST(ClippedFace, AgreesWithClippingInTheTest) {
  Random random(41);
  int compared = 0, empty = 0;
  for (int i = 0; i < 600; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const ShaftMotion motion = random_motion(kind, i % 2 == 0 ? 0.3 : 200, random);
    const ViewingVolume volume = conservative_volume(motion, 0.005, {});
    for (int k = 0; k < 30; ++k) {
      const Triangle face = random_face(motion, random);
      const Triangle in_volume = shifted(face, volume.origin());
      const ConvexPolygon part = part_of(face, volume);
      const Polygon expected = clip_oracle(volume, face);
      ASSERT_EQ(part.empty(), expected.empty()) << motion;
      if (part.empty()) {
        ++empty;
        continue;
      }
      ++compared;
      const Vector3d normal = twice_area(in_volume);
      EXPECT_NEAR((area(part) - area(expected)).norm(), 0, 1e-12) << motion;
      EXPECT_GE(area(part).dot(normal), 0) << "the face's turning direction" << motion;
      EXPECT_LT(farthest_corner(expected, part), 1e-12) << motion;
      for (const Vector3d& corner : part) {
        EXPECT_NEAR(normal.normalized().dot(corner - in_volume[0]), 0, 1e-12);
      }
    }
  }
  EXPECT_GT(compared, 3000);
  EXPECT_GT(empty, 500);
}

/// Whether a point of the polygon's plane is inside, by the side of each edge on which it lies.
/// `slack`: twice an area [m^2].
bool contains(const ConvexPolygon& polygon, const Vector3d& point, const Vector3d& normal,
              double slack) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (edge.cross(point - polygon[i]).dot(normal) < -slack) return false;
  }
  return !polygon.empty();
}

// No clipping in this check: the points of the face that satisfy all half-spaces, and no others,
// are in the part.
TEST(ClippedFace, HasThePointsOfTheFaceThatAreInTheVolume) {
  Random random(42);
  int inside = 0, outside = 0;
  for (int i = 0; i < 3000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const ShaftMotion motion = random_motion(kind, 0.3, random);
    const ViewingVolume volume = conservative_volume(motion, 0.005, {});
    const Triangle face = shifted(random_face(motion, random), volume.origin());
    const ConvexPolygon part = clipped(face, volume);
    const Vector3d normal = twice_area(face).normalized();
    for (int k = 0; k < 20; ++k) {
      const double share = random.uniform(0, 1), other = random.uniform(0, 1 - share);
      const Vector3d point = point_at(face, {1 - share - other, share, other});
      double excess = -std::numeric_limits<double>::infinity();
      for (std::size_t plane = 0; plane < volume.half_space_count(); ++plane) {
        const HalfSpace half_space = volume.half_space(plane);
        excess = std::max(excess, half_space.normal.dot(point) - half_space.offset);
      }
      if (std::abs(excess) < 1e-9) continue;
      ++(excess < 0 ? inside : outside);
      EXPECT_EQ(contains(part, point, normal, 1e-12), excess < 0) << motion << excess;
    }
  }
  EXPECT_GT(inside, 3000);
  EXPECT_GT(outside, 3000);
}

TEST(ClippedFace, AFaceInsideStaysAsItIs) {
  const ShaftAxis axis{Vector3d(1, 2, 3), Vector3d(1, 2, 3.2)};
  const ViewingVolume volume = conservative_volume({axis, axis}, 0.005, {});
  const Triangle face = shifted(
      {Vector3d(1, 2, 3.125), Vector3d(1.001, 2, 3.125), Vector3d(1, 2.001, 3.126)}, axis.trocar);
  const ConvexPolygon part = clipped(face, volume);
  ASSERT_EQ(part.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(part[i], face[i]);
}

TEST(ClippedFace, DegenerateFacesKeepWhatTouches) {
  const ViewingVolume box = ViewingVolume::orthographic(
      {Vector3d::Zero(), Vector3d::Zero(), Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
  const Vector3d inside(0.25, -0.5, 0.125), left(-4, -0.5, 0.125), right(4, -0.5, 0.125);
  EXPECT_EQ(clipped({inside, inside, inside}, box).size(), 1u);  // a point
  EXPECT_EQ(clipped({left, right, left}, box).size(), 2u);       // a segment
  EXPECT_TRUE(clipped({left, left, left}, box).empty());
  EXPECT_EQ(clipped({Vector3d(1, 1, 1), Vector3d(5, 1, 1), Vector3d(1, 5, 3)}, box).size(), 1u);
}

}  // namespace
}  // namespace organ_collision
