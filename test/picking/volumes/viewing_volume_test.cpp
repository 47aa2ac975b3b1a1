#include "picking/volumes/viewing_volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// Whether a point is inside according to the clip matrix and the user planes.
bool inside_clip(const ViewingVolume& volume, const Vector3d& point) {
  const Vector3d shifted = point - volume.origin();
  const Eigen::Vector4d clip = volume.clip() * shifted.homogeneous();
  bool inside = clip.head<3>().cwiseAbs().maxCoeff() <= clip.w();
  for (std::size_t i = 0; i < volume.user_plane_count(); ++i) {
    inside = inside && volume.user_planes()[i].dot(shifted.homogeneous()) >= 0;
  }
  return inside;
}

TEST(ViewingVolume, HalfSpacesAgreeWithMatrixAndUserPlanes) {
  Random random(11);
  int inside = 0, outside = 0;
  for (int i = 0; i < 3000; ++i) {
    const ShaftMotion motion =
        i % 3 == 0 ? random_motion(MotionKind::kMovingTrocar, 0.4, random) : paper_motion(random);
    const double radius = random.magnitude(0.0005, 0.02);
    const ViewingVolume volume =
        i % 3 == 1 ? paper_swept_volume(motion, radius) : conservative_volume(motion, radius, {});
    for (int k = 0; k < 30; ++k) {
      const ShaftAxis axis = motion.at(random.uniform(-0.1, 1.1));
      const Vector3d point =
          axis.at(random.uniform(-0.1, 1.1)) + random.uniform(0, 2 * radius) * random.direction();
      const double out = excess(volume, point);
      if (std::abs(out) < 1e-9) continue;
      EXPECT_EQ(inside_clip(volume, point), out < 0) << motion << out;
      ++(out < 0 ? inside : outside);
    }
  }
  EXPECT_GT(inside, 10000);
  EXPECT_GT(outside, 10000);
}

TEST(ViewingVolume, ViewDepthIsTheDistanceBehindTheNearPlane) {
  Random random(12);
  for (int i = 0; i < 1000; ++i) {
    const ShaftMotion motion = paper_motion(random);
    const PaperHexahedron solid(motion, 0.007);
    for (const ViewingVolume& volume :
         {paper_swept_volume(motion, 0.007), paper_naive_volume(motion, 0.007)}) {
      const double depth = random.uniform(0, 1) * solid.height;
      const Vector3d shifted = solid.at(0.001, 0.002, depth) - volume.origin();
      const Eigen::Vector4d clip = volume.clip() * shifted.homogeneous();
      EXPECT_NEAR(volume.view_depth((clip.z() / clip.w() + 1) / 2), depth, 1e-11) << motion;
      EXPECT_EQ(volume.view_depth(0), 0);
      EXPECT_NEAR(volume.view_depth(1), solid.height, 1e-12);
    }
  }
}

/// [1] How far the middle of the face is inside all half-spaces, by the largest coordinate of the
/// face. Clipping in 32 bits loses about 5e-7 of that.
double depth_of_middle(const ViewingVolume& volume) {
  const Triangle face = middle_face(volume);
  const Eigen::Vector3d middle = 0.25 * face[0] + 0.25 * face[1] + 0.5 * face[2];
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    const HalfSpace half_space = volume.half_space(i);
    depth = std::min(depth, half_space.offset - half_space.normal.dot(middle));
  }
  return depth / largest_coordinate(face);
}

// Of the paper's volumes not the naive one, whose planes may cut off the middle of its box, and not
// those of a tool that moves along itself, which are slivers.
TEST(MiddleFace, MeetsEachVolume) {
  Random random(61);
  for (int i = 0; i < 60'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    ShaftMotion motion = random_motion(kind, i % 2 == 0 ? 0.3 : 200, random);
    const double radius = random.magnitude(1e-4, 0.02);
    ASSERT_GT(depth_of_middle(conservative_volume(motion, radius, {0.0, 1.0})), 1e-6) << motion;
    if (i % 3 != 0) continue;
    motion = random_motion(MotionKind::kSideways, 0.3, random);
    ASSERT_GT(depth_of_middle(paper_static_volume(motion.end, radius)), 1e-6) << motion << radius;
    ASSERT_GT(depth_of_middle(paper_swept_volume(motion, radius)), 1e-6) << motion << radius;
    const MovingBox moving = random_box(0.3, random);
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    ASSERT_GT(depth_of_middle(conservative_volume(swept, {0.0, 1.0})), 1e-6) << moving;
  }
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
