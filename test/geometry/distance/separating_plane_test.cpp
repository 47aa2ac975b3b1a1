#include "geometry/distance/separating_plane.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/distance/closest_points.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

double value(const BernsteinQuadratic& q, double t) {
  return (1.0 - t) * (1.0 - t) * q.start + 2.0 * t * (1.0 - t) * q.middle + t * t * q.end;
}

TEST(BernsteinQuadratic, IsPositiveBeforeItsFirstRootAndZeroThere) {
  oracle::Random random(1);
  int roots = 0;
  for (int i = 0; i < 10'000; ++i) {
    const BernsteinQuadratic q{random.scale(1e-9, 1.0), random.sign() * random.scale(1e-9, 1.0),
                               random.sign() * random.scale(1e-9, 1.0)};
    const double root = first_root(q);
    if (root <= 1.0) {
      ++roots;
      EXPECT_GT(root, 0.0);
      EXPECT_NEAR(value(q, root), 0.0, 1e-15);
    } else {
      EXPECT_EQ(root, 2.0);
    }
    for (int step = 0; step < 50; ++step) {
      const double t = step / 50.0 * std::min(root, 1.0);
      EXPECT_GT(value(q, t), -1e-15) << q.start << " " << q.middle << " " << q.end << " at " << t;
    }
  }
  EXPECT_GT(roots, 1000);
}

TEST(BernsteinQuadratic, OfALinearFunction) {
  EXPECT_DOUBLE_EQ(first_root({1.0, 0.25, -0.5}), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(first_root({1.0, 0.5, 0.0}), 1.0);
  EXPECT_EQ(first_root({1.0, 1.5, 2.0}), 2.0);
}

// It falls below zero between positive ends, touches zero, and stays just above it.
TEST(BernsteinQuadratic, OfAParabola) {
  EXPECT_NEAR(first_root({1.0, -1.5, 1.0}), 0.5 - std::sqrt(0.05), 1e-15);
  EXPECT_DOUBLE_EQ(first_root({1.0, -1.0, 1.0}), 0.5);
  EXPECT_EQ(first_root({1.0, -0.999, 1.0}), 2.0);
}

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

class TurningPlaneOf : public testing::TestWithParam<std::size_t> {};

TEST_P(TurningPlaneOf, WhatItKeepsClearStaysFartherThanTheRadius) {
  Random random(20 + GetParam());
  int clear = 0;
  for (int i = 0; i < 2000; ++i) {
    const LinkTrial trial = oracle::make_link_trial(0, GetParam(), random);
    const RigidMotion motion = trial.motion();
    const CoreMotion core(trial.core, motion);
    FaceMotion face{trial.face, trial.face};
    for (Vector3d& corner : face.end) corner += random.scale(1e-5, 0.1) * random.direction();
    const double begin = random.uniform(0.0, 0.5), end = begin + random.scale(1e-4, 0.5);
    const Instant from(begin, core, face), to(end, core, face);
    const double radius = random.uniform(0.0, 1.0) * from.closest.distance;
    if (from.closest.distance < 1e-6) continue;
    const double share = clear_share(from, to, core, radius);
    EXPECT_GE(share, 0.0);
    clear += share > 0.0;
    for (int step = 0; step < 20; ++step) {
      const double time = begin + step / 20.0 * std::min(share, 1.0) * (end - begin);
      EXPECT_GT(closest_points(core.at(time), face.at(time)).distance,
                radius - 1e-12 - oracle::rounding(trial))
          << trial << " at " << time << " of " << begin << " to " << end;
    }
  }
  EXPECT_GT(clear, 1000);
}

INSTANTIATE_TEST_SUITE_P(Kinds, TurningPlaneOf, testing::Range<std::size_t>(0, oracle::kCoreKinds));

// A ball that falls on a face: the bound is exact, since the plane does not turn.
TEST(TurningPlane, IsExactForAPlaneThatDoesNotTurn) {
  const Triangle face = {Vector3d(-1.0, -1.0, 0.2), Vector3d(2.0, -1.0, 0.2),
                         Vector3d(-1.0, 2.0, 0.2)};
  const Vector3d high(0.03, 0.01, 0.7), low(0.05, -0.02, 0.3);
  const CoreMotion ball(ShaftMotion{{high, high}, {low, low}});
  const Instant from(0.0, ball, {face, face}), to(1.0, ball, {face, face});
  EXPECT_TRUE(from.normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-15));
  EXPECT_NEAR(clear_share(from, to, ball, 0.2), 0.75, 1e-14);
  EXPECT_GT(clear_share(from, to, ball, 0.05), 1.0);
}

// The ball passes through the face, so the normals at both instants are opposite.
TEST(TurningPlane, DoesNotTurnIfTheNormalsAreOpposite) {
  const Triangle face = {Vector3d(-1.0, -1.0, 0.2), Vector3d(2.0, -1.0, 0.2),
                         Vector3d(-1.0, 2.0, 0.2)};
  const Vector3d high(0.03, 0.01, 0.7);
  for (const double z : {0.0, -0.1}) {
    const Vector3d low(0.05, -0.02, z);
    const CoreMotion ball(ShaftMotion{{high, high}, {low, low}});
    const Instant from(0.0, ball, {face, face}), to(1.0, ball, {face, face});
    EXPECT_NEAR(clear_share(from, to, ball, 0.1), 0.4 / (0.7 - z), 1e-14);
  }
}

}  // namespace

}  // namespace organ_collision
