#include "geometry/tool/leg_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using oracle::Random;

constexpr double kAngles[] = {0.0, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 2.0, 3.0, 3.14159};

struct Case {
  Isometry3d start, end;
  double angle;
};

Case make_case(double angle, Random& random) {
  const Isometry3d start = oracle::random_pose(0.3, random);
  Isometry3d end = oracle::random_pose(0.3, random);
  end.linear() = start.linear() * oracle::random_turn(angle, random);
  return {start, end, angle};
}

template <typename Check>
void for_each_case(Check check) {
  Random random(1);
  for (const double angle : kAngles) {
    for (int i = 0; i < 100; ++i) check(make_case(angle, random), random);
  }
}

double angle_between(const Isometry3d& a, const Isometry3d& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

TEST(RigidMotion, BeginsAndEndsAtThePosesGiven) {
  for_each_case([](const Case& c, Random& /*random*/) {
    const RigidMotion motion(c.start, c.end);
    EXPECT_LE((motion.at(0.0).matrix() - c.start.matrix()).norm(), 2e-15);
    EXPECT_LE((motion.at(1.0).matrix() - c.end.matrix()).norm(), 2e-15);
    // There is no jump at the ends.
    EXPECT_LE((motion.at(1e-12).matrix() - c.start.matrix()).norm(), 2e-11);
    EXPECT_LE((motion.at(1.0 - 1e-12).matrix() - c.end.matrix()).norm(), 2e-11);
  });
}

TEST(RigidMotion, MakesRotationsOfWhatIsNearlyOne) {
  for_each_case([](const Case& c, Random& /*random*/) {
    Isometry3d worn = c.end;
    worn.linear() *= 1.0 + 1e-6;
    const RigidMotion motion(c.start, worn);
    for (const double time : {0.0, 0.3, 1.0}) {
      const Eigen::Matrix3d turn = motion.at(time).linear();
      EXPECT_LE((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    }
  });
}

TEST(RigidMotion, SaysHowFarItGoes) {
  for_each_case([](const Case& c, Random& /*random*/) {
    const RigidMotion motion(c.start, c.end);
    EXPECT_NEAR(motion.angle(), c.angle, 1e-14);
    EXPECT_NEAR(motion.origin_displacement(), (c.start.translation() - c.end.translation()).norm(),
                1e-15);
  });
}

TEST(RigidMotion, IsRigidAllTheTime) {
  for_each_case([](const Case& c, Random& random) {
    const Isometry3d pose = RigidMotion(c.start, c.end).at(random.uniform(0.0, 1.0));
    EXPECT_LE((pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
              1e-14);
    EXPECT_GT(pose.linear().determinant(), 0.0);
    EXPECT_EQ(pose.matrix().row(3), Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0));
  });
}

TEST(RigidMotion, TurnsAtConstantSpeedTheShorterWayAsQuaternionsDo) {
  for_each_case([](const Case& c, Random& random) {
    const RigidMotion motion(c.start, c.end);
    const double from = random.uniform(0.0, 1.0), to = random.uniform(0.0, 1.0);
    const Isometry3d before = motion.at(from), after = motion.at(to);
    EXPECT_NEAR(angle_between(before, after), std::abs(to - from) * c.angle, 1e-7);
    const Eigen::Quaterniond a(c.start.linear()), b(c.end.linear());
    EXPECT_LE((after.linear() - a.slerp(to, b).toRotationMatrix()).norm(), 1e-9);
    EXPECT_LE(
        (after.translation() - ((1.0 - to) * c.start.translation() + to * c.end.translation()))
            .norm(),
        1e-15);
  });
}

TEST(RigidMotion, HalfATurnIsOneAboutItsAxisEitherWay) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d axis = random.direction();
    const Isometry3d start = oracle::random_pose(0.3, random);
    Isometry3d end = start;
    end.linear() = start.linear() * Eigen::AngleAxisd(M_PI, axis).toRotationMatrix();
    const RigidMotion motion(start, end);
    EXPECT_NEAR(motion.angle(), M_PI, 1e-14);
    const Isometry3d half = motion.at(0.5);
    EXPECT_LE((half.linear() * axis - start.linear() * axis).norm(), 1e-14);
    EXPECT_NEAR(angle_between(start, half), M_PI / 2, 1e-7);
    EXPECT_NEAR(angle_between(half, end), M_PI / 2, 1e-7);
  }
}

TEST(RigidMotion, RestsOnlyIfBothEndsAreTheSame) {
  Random random(6);
  const Isometry3d start = oracle::random_pose(0.3, random);
  EXPECT_TRUE(RigidMotion(start, start).rests());
  Isometry3d turned = start, moved = start;
  turned.linear() = start.linear() * oracle::random_turn(1e-9, random);
  moved.translation().y() += 1e-15;
  EXPECT_FALSE(RigidMotion(start, turned).rests());
  EXPECT_FALSE(RigidMotion(start, moved).rests());
}

using Eigen::Vector3d;
using oracle::LinkTrial;

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
