#include "contact_adapter/penalty_forces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "ros/messages/failure_log.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kStiffness = 250.0;
/// [N], [N m] The tolerance for several springs: a few millionths of the largest force.
constexpr double kSearched = 1e-4;

struct Wrench {
  Vector3d force, torque;
};

Push push(const Vector3d& place, const Vector3d& normal, double depth) {
  return {place, normal.normalized(), depth, true};
}

Wrench wrench(const std::vector<Push>& pushes, double stiffness = kStiffness) {
  const std::vector<Vector3d> forces = penalty_forces(pushes, stiffness);
  Wrench sum{Vector3d::Zero(), Vector3d::Zero()};
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    sum.force += forces[i];
    sum.torque += pushes[i].place.cross(forces[i]);
  }
  return sum;
}

void expect_near(const Vector3d& found, const Vector3d& expected, double tolerance = 1e-12) {
  EXPECT_LE((found - expected).norm(), tolerance)
      << found.transpose() << " instead of " << expected.transpose();
}

void expect_same(const Wrench& found, const Wrench& expected, double tolerance = 1e-12) {
  expect_near(found.force, expected.force, tolerance);
  expect_near(found.torque, expected.torque, tolerance);
}

/// Pushes with random places, normals in all directions, and some negative depths.
std::vector<Push> scattered_pushes(std::mt19937& random, int count) {
  std::normal_distribution<double> number(0.0, 0.01);
  std::vector<Push> pushes;
  for (int i = 0; i < count; ++i) {
    const Vector3d point(number(random), number(random), number(random));
    const Vector3d normal(number(random), number(random), number(random));
    pushes.push_back(push(point, normal, number(random)));
  }
  return pushes;
}

}  // namespace

TEST(PenaltyForces, OneContactIsASpring) {
  const Wrench found = wrench({push({0.1, 0.2, 0.3}, {0.0, 0.0, -1.0}, 0.004)});
  expect_near(found.force, {0.0, 0.0, 1.0});  // 250 N/m * 4 mm, against the normal
  expect_near(found.torque, {0.2, -0.1, 0.0});
}

TEST(PenaltyForces, NothingTouchedOrAllLeftIsZero) {
  expect_same(wrench({}), {Vector3d::Zero(), Vector3d::Zero()}, 0.0);
  const Push left = push({0.1, 0.2, 0.3}, {1.0, 0.5, 0.0}, -0.002);
  const Push grazed = push({0.1, 0.2, 0.3}, {1.0, 0.5, 0.0}, 0.0);
  expect_same(wrench({left, grazed}), {Vector3d::Zero(), Vector3d::Zero()}, 0.0);
}

TEST(PenaltyForces, WhatWasLeftDoesNotCount) {
  const Push deep = push({0.1, 0.2, 0.3}, {0.3, 0.5, -1.0}, 0.004);
  const Push left = push({0.12, 0.2, 0.29}, {1.0, 0.5, 0.0}, -0.05);
  expect_same(wrench({left, deep}), wrench({deep}), 0.0);
}

TEST(PenaltyForces, SplittingSomeFacesMoreThanOthersChangesNoForce) {
  // Two walls and a floor. Each consists of several pushes in one plane.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> way(-0.002, 0.002);
  const std::vector<Push> whole = {push({0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.0011),
                                   push({-0.003, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 0.0023),
                                   push({0.0, 0.0, -0.004}, {0.0, 0.2, -1.0}, 0.0009)};
  for (int i = 0; i < 50; ++i) {
    std::vector<Push> split;
    for (const Push& face : whole) {
      const Vector3d across = face.normal.unitOrthogonal();
      const int pieces = 1 + static_cast<int>(random() % 40);
      for (int piece = 0; piece < pieces; ++piece) {
        const Vector3d inside = way(random) * across + way(random) * face.normal.cross(across);
        split.push_back(face);
        split.back().place += inside;
      }
    }
    expect_near(wrench(split).force, wrench(whole).force, kSearched);
  }
}

TEST(PenaltyForces, SplittingAllFacesAlikeChangesNothing) {
  std::mt19937 random(4);
  for (int i = 0; i < 50; ++i) {
    const std::vector<Push> whole = scattered_pushes(random, 10);
    std::vector<Push> split;
    for (int piece = 0; piece < 5; ++piece) split.insert(split.end(), whole.begin(), whole.end());
    expect_same(wrench(split), wrench(whole), kSearched);
  }
}

TEST(PenaltyForces, OrderDoesNotMatter) {
  std::mt19937 random(6);
  for (int i = 0; i < 50; ++i) {
    std::vector<Push> pushes = scattered_pushes(random, 10);
    pushes[3].depth = pushes[4].depth = pushes[5].depth = 0.02;
    const Wrench expected = wrench(pushes);
    std::shuffle(pushes.begin(), pushes.end(), random);
    expect_same(wrench(pushes), expected, kSearched);
  }
}

TEST(PenaltyForces, TurnsWithTheContacts) {
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    std::vector<Push> pushes = scattered_pushes(random, 10);
    const Wrench before = wrench(pushes);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(0.3 + i, Vector3d(1.0, -2.0, 0.5 + i).normalized()).toRotationMatrix();
    for (Push& p : pushes) {
      p.place = R * p.place;
      p.normal = R * p.normal;
    }
    expect_same(wrench(pushes), {R * before.force, R * before.torque}, kSearched);
  }
}

TEST(PenaltyForces, MovedContactsAddTheLeverAlone) {
  std::mt19937 random(8);
  const Vector3d shift(0.3, -0.2, 0.1);
  std::vector<Push> pushes = scattered_pushes(random, 10);
  const Wrench before = wrench(pushes);
  for (Push& p : pushes) p.place += shift;
  expect_same(wrench(pushes), {before.force, before.torque + shift.cross(before.force)}, 1e-12);
}

TEST(PenaltyForces, IsProportionalToTheStiffness) {
  std::mt19937 random(9);
  const std::vector<Push> pushes = scattered_pushes(random, 10);
  const Wrench soft = wrench(pushes, 1.0);
  expect_same(wrench(pushes, 800.0), {800.0 * soft.force, 800.0 * soft.torque}, 1e-12);
}

TEST(PenaltyForces, OppositeEqualContactsCancel) {
  const Push right = push({0.004, 0.01, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  const Push left = push({-0.004, 0.01, 0.0}, {-1.0, 0.0, 0.0}, 0.001);
  expect_same(wrench({right, left}), {Vector3d::Zero(), Vector3d::Zero()});
}

TEST(PenaltyForces, OppositeWallsAreSpringsOfTheirOwn) {
  const Push right = push({0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  const Push left = push({-0.002, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 0.003);
  expect_near(wrench({right, left}).force, {kStiffness * 0.002, 0.0, 0.0});
}

TEST(PenaltyForces, OppositePushesAtTwoPlacesTurnTheTool) {
  const Push right = push({0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  const Push left = push({-0.004, 0.0, 0.1}, {-1.0, 0.0, 0.0}, 0.001);
  const Wrench found = wrench({right, left});
  expect_near(found.force, Vector3d::Zero());
  expect_near(found.torque, {0.0, kStiffness * 0.001 * 0.1, 0.0});
}

TEST(PenaltyForces, WallsAtRightAnglesAreSpringsOfTheirOwn) {
  const Push wall = push({0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  const Push floor = push({0.0, 0.0, -0.003}, {0.0, 0.0, -1.0}, 0.002);
  expect_near(wrench({wall, floor}).force, {-kStiffness * 0.001, 0.0, kStiffness * 0.002});
}

TEST(PenaltyForces, InACreaseTheForceIsOfTheSmallestShiftThatLeavesBothSides) {
  // Both sides rise by 30 degrees. To leave both, the ball must rise by depth / cos(30 degrees).
  const double radius = 0.005, depth = 0.001, angle = M_PI / 6.0;
  const Vector3d a(std::sin(angle), 0.0, -std::cos(angle)), b(-a.x(), 0.0, a.z());
  const std::vector<Push> sides = {push((radius - depth) * a, a, depth),
                                   push((radius - depth) * b, b, depth)};
  expect_near(wrench(sides).force, {0.0, 0.0, kStiffness * depth / std::cos(angle)}, kSearched);
}

TEST(PenaltyForces, InADentOfTheToolsShapeTheForceIsOneContacts) {
  // A half ball that is pressed down by `shift`. The depths are the components along the normals.
  const double radius = 0.005, shift = 0.0002;
  for (const int rings : {2, 5, 20}) {
    std::vector<Push> pushes = {push({0.0, 0.0, -radius}, {0.0, 0.0, -1.0}, shift)};
    for (int ring = 1; ring < rings; ++ring) {
      const double polar = 0.5 * M_PI * ring / rings;
      for (int k = 0; k < 6 * ring; ++k) {
        const double azimuth = 2.0 * M_PI * k / (6 * ring);
        const Vector3d normal(std::sin(polar) * std::cos(azimuth),
                              std::sin(polar) * std::sin(azimuth), -std::cos(polar));
        pushes.push_back(push(radius * normal, normal, shift * std::cos(polar)));
      }
    }
    expect_near(wrench(pushes).force, {0.0, 0.0, kStiffness * shift}, kSearched);
  }
}

TEST(PenaltyForces, AShaftThatLiesOnTheTissueIsPushedAtItsMiddle) {
  std::vector<Push> pushes;
  for (int i = 0; i <= 10; ++i) pushes.push_back(push({0.01 * i, 0.0, 0.0}, {0, 0, -1}, 0.001));
  const Wrench found = wrench(pushes);
  expect_near(found.force, {0.0, 0.0, 0.25});
  expect_near(found.torque, {0.0, -0.05 * 0.25, 0.0});
}

TEST(PenaltyForces, ALinkThatCoversAnotherAddsNothing) {
  std::mt19937 random(10);
  for (int i = 0; i < 50; ++i) {
    std::vector<Push> pushes = scattered_pushes(random, 10);
    const Wrench alone = wrench(pushes);
    for (std::size_t k = 0; k < 10; ++k) pushes.push_back(Push(pushes[k]));
    expect_same(wrench(pushes), alone, kSearched);
  }
}

TEST(PenaltyForces, WhatDoesNotCountMovesThePlaceAlone) {
  Push beside = push({0.02, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.001);
  beside.counts = false;
  const Wrench found = wrench({push({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.001), beside});
  expect_near(found.force, {0.0, 0.0, 0.25});
  expect_near(found.torque, {0.0, -0.01 * 0.25, 0.0});
}

TEST(PenaltyForces, JawsThatCloseOnTissueAreSpringsOfTheirOwn) {
  Push left = push({-0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  Push right = push({0.004, 0.0, 0.02}, {-1.0, 0.0, 0.0}, 0.003);
  const Wrench found = wrench({left, right});
  expect_near(found.force, {kStiffness * 0.002, 0.0, 0.0});
  expect_near(found.torque, {0.0, kStiffness * 0.003 * 0.02, 0.0});
}

TEST(PenaltyForces, EachPushHasAShareOfTheForce) {
  // The second push is twice as deep, and leans by 60 degrees. The third one has been left.
  const std::vector<Vector3d> forces =
      penalty_forces({push({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.004),
                      push({0.1, 0.0, 0.0}, {std::sqrt(0.75), 0.0, -0.5}, 0.002),
                      push({0.2, 0.0, 0.0}, {0.0, 0.0, -1.0}, -0.001)},
                     kStiffness);
  ASSERT_EQ(forces.size(), 3u);
  expect_near(forces[0], {0.0, 0.0, 0.8});
  expect_near(forces[1], {0.0, 0.0, 0.2});
  expect_near(forces[2], Vector3d::Zero());
}

TEST(PenaltyForces, AForceThatIsNotFiniteIsRefused) {
  const Push deep = push({0.1, 0.2, 0.3}, {0.0, 0.0, -1.0}, 1e300);
  EXPECT_THROW(penalty_forces({deep}, 1e300), Rejection);
  EXPECT_THROW(penalty_forces({deep, deep}, 1e300), Rejection);
}
