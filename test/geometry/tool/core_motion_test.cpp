#include "geometry/tool/core_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

/// Support points of the core, for the same directions of the link at every pose.
std::vector<Vector3d> points_of(const ConvexCore& core, const Eigen::Isometry3d& pose) {
  Random random(5);
  std::vector<Vector3d> points;
  for (int i = 0; i < 30; ++i) points.push_back(pose * core.support(random.direction()));
  return points;
}

class CoreMotionOf : public testing::TestWithParam<std::size_t> {
 protected:
  /// Calls `check(trial, motion of the link, motion of the core, random)` for all kinds of motion.
  template <typename Check>
  void for_each_motion(Check check) {
    Random random(40 + GetParam());
    for (int i = 0; i < 200; ++i) {
      const LinkTrial trial = oracle::make_link_trial(0, GetParam(), random);
      const RigidMotion motion = trial.motion();
      check(trial, motion, CoreMotion(trial.core, motion), random);
    }
  }
};

TEST_P(CoreMotionOf, IsTheCoreWhereTheLinkIs) {
  for_each_motion([](const LinkTrial& trial, const RigidMotion& motion, const CoreMotion& core,
                     Random& random) {
    EXPECT_EQ(core.link(), &motion);
    for (const double time : {0.0, 1.0, random.uniform(0.0, 1.0)}) {
      const ConvexCore at = core.at(time), expected = motion.at(time) * trial.core;
      EXPECT_EQ(at.count, trial.core.count);
      EXPECT_EQ(at.rim, expected.rim);
      for (std::size_t i = 0; i < at.count; ++i) EXPECT_EQ(at.points[i], expected.points[i]);
    }
    EXPECT_EQ(core.start().points[0], core.at(0.0).points[0]);
    EXPECT_EQ(core.end().points[0], core.at(1.0).points[0]);
  });
}

TEST_P(CoreMotionOf, FarthestMoveBoundsTheWayOfEveryPoint) {
  for_each_motion([](const LinkTrial& trial, const RigidMotion& motion, const CoreMotion& core,
                     Random& /*random*/) {
    constexpr int kSteps = 100;
    std::vector<double> ways(30, 0.0);
    std::vector<Vector3d> before = points_of(trial.core, motion.at(0.0));
    for (int step = 1; step <= kSteps; ++step) {
      const auto now = points_of(trial.core, motion.at(static_cast<double>(step) / kSteps));
      for (std::size_t i = 0; i < now.size(); ++i) {
        const double way = (now[i] - before[i]).norm();
        EXPECT_LE(way, core.farthest_move() / kSteps + 1e-14) << "at any time, not on average";
        ways[i] += way;
      }
      before = now;
    }
    EXPECT_LE(*std::max_element(ways.begin(), ways.end()), core.farthest_move() + 1e-13);
  });
}

TEST_P(CoreMotionOf, NoPointLeavesItsChordByMoreThanTheDeviation) {
  for_each_motion([](const LinkTrial& trial, const RigidMotion& motion, const CoreMotion& core,
                     Random& random) {
    const double from = random.uniform(0.0, 1.0), to = random.uniform(from, 1.0);
    const auto first = points_of(trial.core, motion.at(from));
    const auto last = points_of(trial.core, motion.at(to));
    for (int step = 0; step <= 20; ++step) {
      const double share = step / 20.0;
      const auto now = points_of(trial.core, motion.at(from + share * (to - from)));
      for (std::size_t i = 0; i < now.size(); ++i) {
        const Vector3d on_chord = (1.0 - share) * first[i] + share * last[i];
        EXPECT_LE((now[i] - on_chord).norm(),
                  4.0 * share * (1.0 - share) * core.chord_deviation(to - from) + 1e-15);
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, CoreMotionOf, testing::Range<std::size_t>(0, oracle::kCoreKinds));

// The bounds are reached by a point as far from the axis as the core reaches.
TEST(CoreMotion, BoundsAreTightForAPointThatTurns) {
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity(), end = start;
  end.linear() = Eigen::AngleAxisd(0.01, Vector3d::UnitZ()).toRotationMatrix();
  ConvexCore core;
  core.count = 1;
  core.points[0] = {0.3, 0.0, 0.0};
  const RigidMotion motion(start, end);
  const CoreMotion point(core, motion);
  EXPECT_NEAR(point.farthest_move(), 0.3 * 0.01, 1e-16);
  const Vector3d chord = 0.5 * (point.at(0.0).points[0] + point.at(1.0).points[0]);
  const double off = (point.at(0.5).points[0] - chord).norm();
  EXPECT_NEAR(point.chord_deviation(1.0), off, 1e-4 * off);
}

TEST(CoreMotion, OfAShaftHasNoChordDeviation) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const ShaftMotion shaft = oracle::make_trial(0, random).motion;
    const CoreMotion core(shaft);
    EXPECT_EQ(core.link(), nullptr);
    EXPECT_EQ(core.chord_deviation(1.0), 0.0);
    EXPECT_EQ(core.farthest_move(), std::max((shaft.end.tip - shaft.start.tip).norm(),
                                             (shaft.end.trocar - shaft.start.trocar).norm()));
    const double time = random.uniform(0.0, 1.0);
    EXPECT_LE((core.at(time).axis().tip - shaft.at(time).tip).norm(), 1e-16);
    EXPECT_LE((core.at(time).axis().trocar - shaft.at(time).trocar).norm(), 1e-16);
  }
}

}  // namespace
}  // namespace organ_collision
