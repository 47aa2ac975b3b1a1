#include "picking/volumes/viewing_volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "excess.hpp"
#include "paper_hexahedron.hpp"
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

TEST(ViewingVolume, HasRoomForEightUserPlanes) {
  ViewingVolume volume = paper_static_volume({Vector3d(1, 2, 3), Vector3d(1.2, 2, 3.1)}, 0.01);
  for (std::size_t i = 0; i < ViewingVolume::kMaxUserPlanes; ++i) {
    volume.add_user_plane({Vector3d(0.6, 0, 0.8), 0.1 * static_cast<double>(i)});
  }
  EXPECT_EQ(volume.half_space_count(), 14u);
  EXPECT_NEAR(volume.half_space(13).offset, 0.7, 1e-15);
  EXPECT_NEAR((volume.half_space(13).normal - Vector3d(0.6, 0, 0.8)).norm(), 0, 1e-15);
  EXPECT_THROW(volume.add_user_plane({Vector3d::UnitX(), 1}), std::out_of_range);
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

}  // namespace
}  // namespace organ_collision
