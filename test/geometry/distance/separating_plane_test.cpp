#include "geometry/distance/separating_plane.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/distance/closest_points.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

TEST(SeparatingPlane, NormalIsUnitHoweverSmallTheTriangle) {
  for (const double size : {1e-150, 1.0, 1e5}) {
    const Triangle triangle = {Vector3d::Zero(), size * Vector3d::UnitX(),
                               size * Vector3d::UnitY()};
    EXPECT_TRUE(plane_normal(triangle).isApprox(Vector3d::UnitZ(), 1e-15)) << size;
  }
  const Vector3d point(0.1, 0.2, 0.3);
  EXPECT_EQ(plane_normal({point, point, point}), Vector3d::Zero());
}

TEST(SeparatingPlane, ProjectionRunsFromTheLowestToTheHighestCorner) {
  const Triangle triangle = {Vector3d(0.0, 0.0, 0.3), Vector3d(1.0, 0.0, -0.2),
                             Vector3d(0.0, 1.0, 0.1)};
  const ProjectionInterval interval = project_onto(2.0 * Vector3d::UnitZ(), triangle);
  EXPECT_EQ(interval.low, -0.4);
  EXPECT_EQ(interval.high, 0.6);
}

TEST(SeparatingPlane, FirstZeroOfALinearGap) {
  EXPECT_EQ(first_zero(0.3, 0.1), 2.0);
  EXPECT_DOUBLE_EQ(first_zero(0.3, -0.1), 0.75);
  EXPECT_EQ(first_zero(0.3, 0.0), 1.0);
  EXPECT_EQ(first_zero(0.0, 1.0), 0.0);
  EXPECT_EQ(first_zero(-0.1, 1.0), 0.0);
}

// The face lies above the part or below it, and comes nearer.
TEST(SeparatingPlane, ClearUntilTheIntervalsAreWithinReach) {
  const ProjectionInterval part{-0.1, 0.1};
  EXPECT_NEAR(clear_until({0.3, 0.5}, {0.1, 0.4}, part, part, 0.1), 0.5, 1e-15);
  EXPECT_NEAR(clear_until({-0.5, -0.3}, {-0.4, -0.1}, part, part, 0.1), 0.5, 1e-15);
  EXPECT_EQ(clear_until({0.3, 0.5}, {0.3, 0.5}, part, part, 0.1), 2.0);
  EXPECT_EQ(clear_until({0.15, 0.5}, {0.3, 0.5}, part, part, 0.1), 0.0);
}

TEST(SeparatingPlane, WhatStaysBeyondIsFartherDuringTheWholeLeg) {
  Random random(1);
  int beyond = 0;
  for (int i = 0; i < 4000; ++i) {
    const LinkTrial trial = oracle::make_link_trial(0, i % oracle::kCoreKinds, random);
    const RigidMotion motion = trial.motion();
    const CoreMotion core(trial.core, motion);
    FaceMotion face{trial.face, trial.face};
    for (Vector3d& corner : face.end) corner += random.scale(1e-5, 0.1) * random.direction();
    const ClosestPoints closest = closest_points(core.start(), face.start);
    const double distance = random.uniform(0.0, 1.0) * closest.distance;
    if (!stays_beyond(closest.separation.normalized(), core, face, distance)) continue;
    ++beyond;
    for (int step = 0; step <= 20; ++step) {
      const double time = step / 20.0;
      EXPECT_GT(closest_points(core.at(time), face.at(time)).distance,
                distance - oracle::rounding(trial));
    }
  }
  EXPECT_GT(beyond, 200);
}

}  // namespace
}  // namespace organ_collision
