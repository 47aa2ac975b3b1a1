#include "geometry/distance/relative_face.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/distance/closest_points.hpp"
#include "geometry/distance/first_touch.hpp"
#include "geometry/distance/separating_plane.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

constexpr std::size_t kBox = 2;  // the number of this kind of core

/// The box with the core of a trial.
OrientedBox box_of(const ConvexCore& core) {
  const auto& p = core.points;
  OrientedBox box{0.5 * (p[0] + p[7]), {}, {}};
  const std::array<Vector3d, 3> edges = {p[4] - p[0], p[2] - p[0], p[1] - p[0]};
  for (int i = 0; i < 3; ++i) {
    box.half_size[i] = 0.5 * edges[i].norm();
    box.axes.col(i) = edges[i].normalized();
  }
  return box;
}

/// The face of a trial, away from where it was, and moving or not. Some faces are small.
FaceMotion moved_away(const LinkTrial& trial, Random& random) {
  FaceMotion face{trial.face, trial.face};
  const Vector3d by = random.scale(1e-4, 0.3) * random.direction();
  const double size = random.chance(0.5) ? 1.0 : random.scale(1e-3, 1.0);
  const bool moves = random.chance(0.5);
  for (int i = 0; i < 3; ++i) {
    face.start[i] = trial.face[0] + size * (trial.face[i] - trial.face[0]) + by;
    face.end[i] = face.start[i];
    if (moves) face.end[i] += random.scale(1e-5, 0.1) * random.direction();
  }
  return face;
}

/// Checks at many times before `until` that core and face are farther apart than `reach` [m].
void expect_clear(double until, const ConvexCore& in_link, const RigidMotion& motion,
                  const FaceMotion& face, double reach, double rounding, Random& random) {
  for (int i = 0; i < 100; ++i) {
    // At `until` itself the distance may equal `reach`, except for rounding.
    const double time = std::min(until, 1.0) * (i < 2 ? i : random.uniform(0.0, 1.0));
    EXPECT_GT(closest_points(motion.at(time) * in_link, face.at(time)).distance, reach - rounding)
        << "at " << time;
  }
}

class RelativeFaceTrials : public testing::TestWithParam<std::size_t> {
 protected:
  template <typename Check>
  void for_each_trial(int count, Check check) {
    Random random(50 + GetParam());
    for (int i = 0; i < count && !HasFailure(); ++i) {
      const LinkTrial trial = oracle::make_link_trial(GetParam(), kBox, random);
      check(trial, random);
      if (HasFailure()) ADD_FAILURE() << trial;
    }
  }
};

TEST_P(RelativeFaceTrials, WhatStaysClearOfABoxStaysFartherThanTheReach) {
  int clear = 0;
  for_each_trial(2000, [&](const LinkTrial& trial, Random& random) {
    const RigidMotion motion = trial.motion();
    const FaceMotion face = moved_away(trial, random);
    const double until = RelativeFace(face, motion).clear_until(box_of(trial.core), trial.radius);
    if (until == 0.0) return;
    ++clear;
    expect_clear(until, trial.core, motion, face, trial.radius, oracle::rounding(trial), random);
  });
  EXPECT_GT(clear, 200);
}

TEST_P(RelativeFaceTrials, WhatStaysClearOfATriangleStaysFartherThanTheReach) {
  int clear = 0;
  for_each_trial(2000, [&](const LinkTrial& trial, Random& random) {
    const RigidMotion motion = trial.motion();
    const FaceMotion face = moved_away(trial, random);
    const auto& p = trial.core.points;
    const Triangle triangle = {p[0], p[1], p[2]};
    const double until =
        RelativeFace(face, motion).clear_until(triangle, plane_normal(triangle), trial.radius);
    if (until == 0.0) return;
    ++clear;
    expect_clear(until, ConvexCore(triangle), motion, face, trial.radius, oracle::rounding(trial),
                 random);
  });
  EXPECT_GT(clear, 200);
}

INSTANTIATE_TEST_SUITE_P(Kinds, RelativeFaceTrials,
                         testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()));

// This is what the test is for: it excludes nearly all faces that are far away, large or small.
TEST(RelativeFace, StaysClearOfNearlyAllThatIsFar) {
  Random random(7);
  for (const double size : {1.0, 0.01}) {
    int far = 0, clear = 0;
    for (int i = 0; i < 3000; ++i) {
      LinkTrial trial = oracle::make_link_trial(0, kBox, random);
      trial.end.linear() = trial.start.linear() * oracle::random_turn(0.01, random);
      trial.end.translation() = trial.start.translation() + 1e-3 * random.direction();
      const Vector3d by = 0.03 * random.direction();
      const Vector3d first = trial.face[0] + by;
      for (Vector3d& corner : trial.face) corner = first + size * (corner + by - first);
      const RigidMotion motion = trial.motion();
      const FaceMotion face{trial.face, trial.face};
      if (first_touch(CoreMotion(trial.core, motion), face, 0.01)) continue;
      ++far;
      clear += RelativeFace(face, motion).clear_until(box_of(trial.core), 1e-3) > 1.0;
    }
    EXPECT_GT(clear, far * 8 / 10) << "of " << far;
  }
}

const OrientedBox kCube{Vector3d::Zero(), Eigen::Matrix3d::Identity(), {0.1, 0.1, 0.1}};

RelativeFace at_rest(const Triangle& face) {
  return {{face, face}, RigidMotion(Isometry3d::Identity(), Isometry3d::Identity())};
}

// The projections onto the box's axes overlap. Only the face's own plane separates the two.
TEST(RelativeFace, IsClearOfABoxBehindItsPlane) {
  const auto face = [](double x) {
    return at_rest({Vector3d(x, 0, 0), Vector3d(0, x, 0), Vector3d(0, 0, x)});
  };
  const double touching = 0.3 + 0.01 * std::sqrt(3.0);
  EXPECT_GT(face(touching + 1e-9).clear_until(kCube, 0.01), 1.0);
  EXPECT_EQ(face(touching - 1e-9).clear_until(kCube, 0.01), 0.0);
}

// For a degenerate face only the planes across the box's axes can separate the two.
TEST(RelativeFace, NeedsNoPlaneOfItsOwn) {
  const Vector3d far(0.0, 0.2, 0.0), near(0.0, 0.105, 0.0);
  EXPECT_GT(at_rest({far, far, far}).clear_until(kCube, 0.01), 1.0);
  EXPECT_EQ(at_rest({near, far, far}).clear_until(kCube, 0.01), 0.0);
  const Triangle sheet = {Vector3d(1, 0, 0), Vector3d(0, 0, 1), Vector3d(-1, 0, -1)};
  EXPECT_GT(at_rest({far, far, far}).clear_until(sheet, Vector3d::UnitY(), 0.01), 1.0);
  EXPECT_EQ(at_rest({near, far, far}).clear_until(sheet, Vector3d::UnitY(), 0.11), 0.0);
}

// A face that rests is seen from a turning link on an arc, which bulges beyond its chord.
TEST(RelativeFace, CountsTheArcOnWhichATurningLinkSeesIt) {
  Isometry3d end = Isometry3d::Identity();
  end.linear() = Eigen::AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix();
  const RigidMotion motion(Isometry3d::Identity(), end);
  const auto turned = [](double angle, double z) {
    return Vector3d(0.2 * std::cos(angle), 0.2 * std::sin(angle), z);
  };
  // Half way, the face crosses the link's x axis at 0.2 m; on the chord it is 6 mm nearer.
  const Triangle corners = {turned(0.25, 0.0), turned(0.25, 1e-3), turned(0.25, -1e-3)};
  const OrientedBox box{{0.25, 0, 0}, Eigen::Matrix3d::Identity(), {0.048, 0.01, 0.01}};
  EXPECT_LE(RelativeFace({corners, corners}, motion).clear_until(box, 0.003), 1.0);
}

}  // namespace
}  // namespace organ_collision
