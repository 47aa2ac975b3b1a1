#include "geometry/tool/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace organ_collision
