#include "picking/volumes/paper_volumes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

TEST(PaperStaticVolume, IsTheBoxAroundTheAxis) {
  const Vector3d trocar(0.3, -0.2, 0.1);
  const Vector3d tip = trocar + Vector3d(0.06, 0, 0.08);
  const ViewingVolume volume = paper_static_volume({trocar, tip}, 0.005);
  EXPECT_EQ(volume.user_plane_count(), 0u);
  // The frame's y axis is perpendicular to the shaft's axis, so it is the camera's up vector.
  const Vector3d forward(0.6, 0, 0.8), up = Vector3d::UnitY(), across(0.8, 0, -0.6);
  for (const double side : {-1.0, 1.0}) {
    for (const double edge : {-1.0, 1.0}) {
      for (const double depth : {0.0, 0.1}) {
        const Vector3d corner =
            trocar + 0.005 * side * up + 0.005 * edge * across + depth * forward;
        EXPECT_NEAR(excess(volume, corner), 0, 1e-15);
        EXPECT_LT(excess(volume, corner + 0.01 * (trocar + 0.05 * forward - corner)), -1e-6);
        EXPECT_GT(excess(volume, corner + 1e-6 * side * up), 9e-7);
        EXPECT_GT(excess(volume, corner + 1e-6 * edge * across), 9e-7);
        EXPECT_GT(excess(volume, corner + 1e-6 * (depth > 0 ? 1 : -1) * forward), 9e-7);
      }
    }
  }
}

TEST(PaperStaticVolume, UpIsTheFrameAxisLeastAligned) {
  Random random(13);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d view = random.direction();
    const ViewingVolume volume =
        paper_static_volume({Vector3d(1, 1, 1), Vector3d(1, 1, 1) + 0.2 * view}, 0.01);
    Eigen::Index least;
    view.cwiseAbs().minCoeff(&least);
    const Vector3d side = volume.half_space(0).normal;
    EXPECT_NEAR(side[least], 0, 1e-14);
    EXPECT_NEAR(side.dot(view), 0, 1e-14);
  }
}

TEST(PaperSweptVolume, IsThePapersHexahedron) {
  Random random(14);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const ShaftMotion motion = paper_motion(random);
    const double radius = random.magnitude(0.0005, 0.01);
    const PaperHexahedron solid(motion, radius);
    const ViewingVolume swept = paper_swept_volume(motion, radius);
    const ViewingVolume naive = paper_naive_volume(motion, radius);
    EXPECT_EQ(swept.user_plane_count(), 2u);
    EXPECT_EQ(naive.user_plane_count(), 2u);
    const std::vector<Vector3d> corners = solid.corners();
    for (const Vector3d& corner : corners) {
      EXPECT_NEAR(excess(swept, corner), 0, 1e-10) << motion;
      EXPECT_NEAR(excess(naive, corner), 0, 1e-10) << motion;
    }
    for (int k = 0; k < 50; ++k) {
      const Vector3d point =
          solid.at(random.uniform(-2 * radius + std::min(0.0, solid.start),
                                  2 * radius + std::max(0.0, solid.end)),
                   random.uniform(-1.2, 1.2) * radius, random.uniform(-0.1, 1.1) * solid.height);
      const double out = excess(swept, point);
      if (std::abs(out) < 1e-10) continue;
      EXPECT_EQ(out < 0, solid.contains(point)) << motion;
      EXPECT_EQ(excess(naive, point) < 0, solid.contains(point)) << motion;
      inside += out < 0;
    }
  }
  EXPECT_GT(inside, 10000);
}

TEST(PaperVolumes, DegenerateMotionsAreStaticToTheFartherTip) {
  const Vector3d trocar(0.1, 0.2, -0.3);
  const Vector3d axis(0.03, -0.05, 0.11);
  const auto to = [&](double share) -> ShaftAxis { return {trocar, trocar + share * axis}; };
  struct Case {
    ShaftMotion motion;
    double farther;
  };
  const std::vector<Case> cases = {{{to(1), to(1)}, 1},     {{to(1), to(2)}, 2},
                                   {{to(2), to(0.5)}, 2},   {{to(0), to(1)}, 1},
                                   {{to(1), to(0)}, 1},     {{to(1), to(-2)}, -2},
                                   {{to(-1), to(0.3)}, -1}, {{to(1), to(1 + 1e-14)}, 1}};
  for (const Case& example : cases) {
    const ViewingVolume expected = paper_static_volume(to(example.farther), 0.004);
    for (const ViewingVolume& volume :
         {paper_swept_volume(example.motion, 0.004), paper_naive_volume(example.motion, 0.004)}) {
      EXPECT_EQ(volume.user_plane_count(), 0u);
      EXPECT_LT((volume.clip() - expected.clip()).norm(), 1e-9 * expected.clip().norm())
          << example.motion;
    }
  }
}

TEST(PaperVolumes, NeedATipAwayFromTheTrocar) {
  const ShaftAxis point{Vector3d(1, 2, 3), Vector3d(1, 2, 3)};
  EXPECT_THROW(paper_static_volume(point, 0.005), VolumeError);
  EXPECT_THROW(paper_swept_volume({point, point}, 0.005), VolumeError);
  EXPECT_THROW(paper_naive_volume({point, point}, 0.005), VolumeError);
}

}  // namespace
}  // namespace organ_collision
