#include "geometry/distance/bounded_face.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/distance/separating_plane.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

TEST(BoundedFace, IsInItsBallDuringTheWholeLeg) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    FaceMotion motion;
    const double size = random.scale(1e-6, 1.0);
    for (Vector3d& corner : motion.start) corner = random.point(10.0) + size * random.direction();
    motion.end = motion.start;
    const bool moves = random.chance(0.5);
    for (Vector3d& corner : motion.end) {
      if (moves) corner += random.scale(1e-6, 1.0) * random.direction();
    }
    const BoundedFace face(motion);
    EXPECT_EQ(face.rests, !moves);
    EXPECT_EQ(face.normal, plane_normal(motion.start));
    double farthest = 0.0;
    for (const double time : {0.0, random.uniform(0.0, 1.0), 1.0}) {
      for (const Vector3d& corner : motion.at(time)) {
        farthest = std::max(farthest, (corner - face.center).norm());
      }
    }
    EXPECT_NEAR(face.radius, farthest, 1e-12);
  }
}

TEST(BoundedFace, OfOnePointIsThatPoint) {
  const Triangle corners = {Vector3d(1, 2, 3), Vector3d(1, 2, 3), Vector3d(1, 2, 3)};
  const FaceMotion motion{corners, corners};
  const BoundedFace face(motion);
  EXPECT_EQ(face.normal, Vector3d(0, 0, 0));
  EXPECT_NEAR(face.radius, 0.0, 1e-15);
}

}  // namespace
}  // namespace organ_collision
