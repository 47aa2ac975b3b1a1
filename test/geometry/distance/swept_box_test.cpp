#include "geometry/distance/swept_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/distance/closest_points.hpp"
#include "geometry/distance/first_touch.hpp"
#include "geometry/distance/separating_plane.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "test/proof/link_trials.hpp"
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

void expect_contains(const OrientedBox& box, const Vector3d& point) {
  const Vector3d in_box = box.axes.transpose() * (point - box.center);
  const double slack = 1e-15 * (1.0 + point.norm());
  EXPECT_LE((in_box.cwiseAbs() - box.half_size).maxCoeff(), 100.0 * slack);
}

TEST(ShaftBox, ContainsEveryPositionOfTheAxis) {
  oracle::Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d away = random.chance(0.2) ? random.point(1e3) : random.point(0.1);
    const auto end = [&] { return Vector3d(away + random.scale(1e-6, 0.3) * random.direction()); };
    const ShaftMotion motion{{end(), end()}, {end(), end()}};
    const OrientedBox box = box_around(motion);
    EXPECT_LE((box.axes.transpose() * box.axes - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(box.axes.determinant(), 1.0, 1e-14);
    for (const double time : {0.0, 0.3, 0.5, 1.0}) {
      const ShaftAxis axis = motion.at(time);
      for (const double place : {0.0, 0.4, 1.0}) expect_contains(box, axis.at(place));
    }
  }
}

TEST(ShaftBox, OfAnAxisAtRestHasNoWidth) {
  oracle::Random random(2);
  for (int i = 0; i < 100; ++i) {
    const ShaftAxis axis{random.point(0.1), random.point(0.1)};
    const OrientedBox box = box_around({axis, axis});
    EXPECT_NEAR(box.half_size.x(), 0.5 * (axis.tip - axis.trocar).norm(), 1e-15);
    EXPECT_LE(box.half_size.tail<2>().maxCoeff(), 1e-16);
  }
}

TEST(ShaftBox, OfABallAndOfAMotionAlongTheAxisHasNoWidth) {
  const Vector3d trocar(0.03, -0.07, 0.11), tip(-0.02, 0.05, 0.01);
  EXPECT_EQ(box_around({{tip, tip}, {tip, tip}}).half_size.norm(), 0.0);
  const ShaftMotion along{{trocar, tip}, {trocar, ShaftAxis{trocar, tip}.at(1.7)}};
  EXPECT_LE(box_around(along).half_size.tail<2>().maxCoeff(), 1e-15);
}

using oracle::LinkTrial;

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

class SweptBoxTrials : public testing::TestWithParam<std::size_t> {
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

TEST_P(SweptBoxTrials, HoldsTheGrownBoxAllTheTime) {
  for_each_trial(300, [](const LinkTrial& trial, Random& random) {
    const RigidMotion motion = trial.motion();
    const SweptBox swept(box_of(trial.core), motion, trial.radius);
    EXPECT_LE((swept.axes() * swept.axes().transpose() - Eigen::Matrix3d::Identity()).norm(),
              1e-12);
    EXPECT_GT(swept.axes().determinant(), 0.0);
    EXPECT_LE((swept.origin() - motion.start() * box_of(trial.core).center).norm(),
              oracle::rounding(trial));
    for (int i = 0; i < 50; ++i) {
      const double time = i < 2 ? i : random.uniform(0.0, 1.0);
      const ConvexCore core = motion.at(time) * trial.core;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d along = swept.axes().col(axis);
        const double slack = oracle::rounding(trial);
        EXPECT_LE(core.support_value(along) + trial.radius, swept.high()[axis] + slack);
        EXPECT_GE(-core.support_value(-along) - trial.radius, swept.low()[axis] - slack);
      }
    }
  });
}

// If the link does not turn, the box reaches its bounds.
TEST_P(SweptBoxTrials, IsTightWithoutTurning) {
  for_each_trial(300, [](LinkTrial trial, Random& /*random*/) {
    trial.end.linear() = trial.start.linear();
    const SweptBox swept(box_of(trial.core), trial.motion(), trial.radius);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d along = swept.axes().col(axis);
      const double high = std::max((trial.start * trial.core).support_value(along),
                                   (trial.end * trial.core).support_value(along));
      EXPECT_NEAR(swept.high()[axis], high + trial.radius, 2.0 * oracle::rounding(trial));
    }
  });
}

TEST_P(SweptBoxTrials, WhatStaysClearStaysFartherThanTheRadius) {
  int clear = 0;
  for_each_trial(2000, [&](const LinkTrial& trial, Random& random) {
    FaceMotion face{trial.face, trial.face};
    const double away = random.scale(1e-4, 0.3);
    const Vector3d by = away * random.direction();
    for (int i = 0; i < 3; ++i) {
      face.start[i] += by;
      face.end[i] = face.start[i];
      if (random.chance(0.5)) face.end[i] += random.scale(1e-5, 0.1) * random.direction();
    }
    const RigidMotion motion = trial.motion();
    const double until =
        SweptBox(box_of(trial.core), motion, trial.radius).clear_until(BoundedFace(face));
    if (until == 0.0) return;
    ++clear;
    for (int i = 0; i < 100; ++i) {
      // At `until` itself the distance may equal the radius, except for rounding.
      const double time = std::min(until, 1.0) * (i < 2 ? i : random.uniform(0.0, 1.0));
      EXPECT_GT(closest_points(motion.at(time) * trial.core, face.at(time)).distance,
                trial.radius - oracle::rounding(trial))
          << "at " << time;
    }
  });
  EXPECT_GT(clear, 200);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SweptBoxTrials,
                         testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()));

// This is what the box is for: it excludes nearly all faces that are far away.
TEST(SweptBox, StaysClearOfNearlyAllThatIsFar) {
  Random random(7);
  int far = 0, clear = 0;
  for (int i = 0; i < 3000; ++i) {
    LinkTrial trial = oracle::make_link_trial(0, kBox, random);
    trial.end.linear() = trial.start.linear() * oracle::random_turn(0.01, random);
    trial.end.translation() = trial.start.translation() + 1e-3 * random.direction();
    for (Vector3d& corner : trial.face) corner += 0.03 * random.direction();
    const RigidMotion motion = trial.motion();
    if (first_touch(CoreMotion(trial.core, motion), {trial.face, trial.face}, 0.01)) continue;
    ++far;
    const FaceMotion face{trial.face, trial.face};
    clear += SweptBox(box_of(trial.core), motion, 1e-3).clear_until(BoundedFace(face)) > 1.0;
  }
  EXPECT_GT(clear, far * 8 / 10) << "of " << far;
}

// Faces that are small beside a box at rest are tested by their balls alone.
TEST(SweptBox, StaysClearOfNearlyAllSmallFacesThatAreFar) {
  Random random(8);
  const OrientedBox box{Vector3d::Zero(), Eigen::Matrix3d::Identity(), {0.1, 0.1, 0.1}};
  const Eigen::Isometry3d pose = oracle::random_pose(0.3, random);
  const SweptBox swept(box, RigidMotion(pose, pose), 1e-3);
  int far = 0, clear = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d center = random.point(0.2);
    FaceMotion face;
    for (Vector3d& corner : face.start) corner = pose * (center + 1e-3 * random.direction());
    face.end = face.start;
    const double until = swept.clear_until(BoundedFace(face));
    const double away = (center.cwiseAbs() - box.half_size).maxCoeff();
    if (away < -3e-3) {
      EXPECT_EQ(until, 0.0);
    } else if (away > 3e-3) {
      ++far;
      clear += until > 1.0;
    }
  }
  EXPECT_GT(far, 500);
  EXPECT_EQ(clear, far);
}

// The projections onto the box's axes overlap. Only the face's own plane separates the two.
TEST(SweptBox, StaysClearOfAFaceOverACorner) {
  const auto clear_until = [](const SweptBox& box, const FaceMotion& face, double closer = 0.0) {
    return box.clear_until(BoundedFace(face), closer);
  };
  const OrientedBox box{Vector3d::Zero(), Eigen::Matrix3d::Identity(), {0.1, 0.1, 0.1}};
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const RigidMotion motion(pose, pose);
  const auto face = [](double x) {
    const Triangle corners = {Vector3d(x, 0, 0), Vector3d(0, x, 0), Vector3d(0, 0, x)};
    return FaceMotion{corners, {corners[0], corners[2], corners[1]}};
  };
  const double touching = 0.3 + 0.01 * std::sqrt(3.0);
  EXPECT_GT(clear_until(SweptBox(box, motion, 0.01), face(touching + 1e-9)), 1.0);
  EXPECT_EQ(clear_until(SweptBox(box, motion, 0.01), face(touching - 1e-9)), 0.0);
  constexpr double kCloser = 0.004;  // [m]
  const double nearer = touching - kCloser * std::sqrt(3.0);
  EXPECT_GT(clear_until(SweptBox(box, motion, 0.01), face(nearer + 1e-9), kCloser), 1.0);
  EXPECT_EQ(clear_until(SweptBox(box, motion, 0.01), face(nearer - 1e-9), kCloser), 0.0);
}

// For a degenerate face only the planes across the box's axes can separate the two.
TEST(SweptBox, NeedsNoPlane) {
  const auto clear_until = [](const SweptBox& box, const FaceMotion& face) {
    return box.clear_until(BoundedFace(face));
  };
  const OrientedBox box{Vector3d::Zero(), Eigen::Matrix3d::Identity(), {0.1, 0.1, 0.1}};
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const RigidMotion motion(pose, pose);
  const Vector3d far(0.0, 0.2, 0.0), near(0.0, 0.105, 0.0);
  EXPECT_GT(clear_until(SweptBox(box, motion, 0.01), {{far, far, far}, {far, far, far}}), 1.0);
  EXPECT_EQ(clear_until(SweptBox(box, motion, 0.01), {{near, far, far}, {far, far, far}}), 0.0);
}

}  // namespace

}  // namespace organ_collision
