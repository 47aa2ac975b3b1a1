#include "contact_adapter/springs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "common/messages/failure_log.hpp"
#include "force_trajectory.hpp"
#include "haptics/basins.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kSpring = 250.0;  // [N/m]

/// [N], [N m] The tolerance for several springs: a few millionths of the largest force.
constexpr double kSearched = 1e-4;

struct Wrench {
  Vector3d force, torque;
};

Push push(const Vector3d& place, const Vector3d& normal, double depth) {
  return {place, normal.normalized(), depth, true};
}

Wrench wrench(const std::vector<Push>& pushes, double stiffness = kSpring) {
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

TEST(PenaltyForces, OfAFewPushes) {
  const double angle = M_PI / 6.0;  // Both sides of the crease rise by 30 degrees.
  const Vector3d rising(std::sin(angle), 0.0, -std::cos(angle));
  const Vector3d falling(-rising.x(), 0.0, rising.z());
  const Vector3d down(0.0, 0.0, -1.0), right(1.0, 0.0, 0.0), slanted(0.3, 0.5, -1.0);
  const Vector3d slanted_force = -0.004 * kSpring * slanted.normalized();
  Push beside = push({0.02, 0.0, 0.0}, down, 0.001);
  beside.counts = false;
  std::vector<Push> lying;  // a shaft on the tissue
  for (int i = 0; i <= 10; ++i) lying.push_back(push({0.01 * i, 0.0, 0.0}, down, 0.001));
  struct {
    const char* name;
    std::vector<Push> pushes;
    Vector3d force, torque;  ///< [N], [N m]
  } const rows[] = {
      {"none", {}, {0, 0, 0}, {0, 0, 0}},
      {"one spring", {push({0.1, 0.2, 0.3}, down, 0.004)}, {0, 0, 1.0}, {0.2, -0.1, 0}},
      {"grazed or left",
       {push({0, 0, 1}, right, 0.0), push({0, 0, 1}, right, -0.002)},
       {0, 0, 0},
       {0, 0, 0}},
      {"another face was left",
       {push({0.12, 0.2, 0.29}, right, -0.05), push({0, 0, 0}, slanted, 0.004)},
       slanted_force,
       {0, 0, 0}},
      {"opposite, equal",
       {push({0.004, 0.01, 0}, right, 0.001), push({-0.004, 0.01, 0}, -right, 0.001)},
       {0, 0, 0},
       {0, 0, 0}},
      {"opposite, unequal",
       {push({0.004, 0, 0}, right, 0.001), push({-0.002, 0, 0}, -right, 0.003)},
       {kSpring * 0.002, 0, 0},
       {0, 0, 0}},
      {"jaws at two places",
       {push({-0.004, 0, 0}, right, 0.001), push({0.004, 0, 0.1}, -right, 0.001)},
       {0, 0, 0},
       {0, kSpring * 0.001 * 0.1, 0}},
      {"wall and floor",
       {push({0.004, 0, 0}, right, 0.001), push({0, 0, -0.003}, down, 0.002)},
       {-kSpring * 0.001, 0, kSpring * 0.002},
       {0, 0, 0}},
      // To leave both sides, a ball of 5 mm must rise by depth / cos(30 degrees).
      {"a crease",
       {push(0.004 * rising, rising, 0.001), push(0.004 * falling, falling, 0.001)},
       {0, 0, kSpring * 0.001 / std::cos(angle)},
       {0, 0, 0}},
      {"a shaft that lies", lying, {0, 0, 0.25}, {0, -0.05 * 0.25, 0}},
      {"what does not count moves the place",
       {push({0, 0, 0}, down, 0.001), beside},
       {0, 0, 0.25},
       {0, -0.01 * 0.25, 0}},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    expect_same(wrench(row.pushes), {row.force, row.torque}, kSearched);
  }
}

TEST(PenaltyForces, EachPushHasAShareOfTheForce) {
  // The second push is twice as deep, and leans by 60 degrees. The third one has been left.
  const std::vector<Vector3d> forces =
      penalty_forces({push({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.004),
                      push({0.1, 0.0, 0.0}, {std::sqrt(0.75), 0.0, -0.5}, 0.002),
                      push({0.2, 0.0, 0.0}, {0.0, 0.0, -1.0}, -0.001)},
                     kSpring);
  ASSERT_EQ(forces.size(), 3u);
  expect_near(forces[0], {0.0, 0.0, 0.8});
  expect_near(forces[1], {0.0, 0.0, 0.2});
  expect_near(forces[2], Vector3d::Zero());
}

TEST(PenaltyForces, DoNotDependOnOrderPlaceDirectionOrDoubledFaces) {
  std::mt19937 random(6);
  const Vector3d shift(0.3, -0.2, 0.1);
  for (int i = 0; i < 50; ++i) {
    std::vector<Push> pushes = scattered_pushes(random, 10);
    pushes[3].depth = pushes[4].depth = pushes[5].depth = 0.02;
    const Wrench before = wrench(pushes);
    std::vector<Push> others = pushes;
    std::shuffle(others.begin(), others.end(), random);
    expect_same(wrench(others), before, kSearched);
    for (int piece = 0; piece < 4; ++piece)
      others.insert(others.end(), pushes.begin(), pushes.end());
    expect_same(wrench(others), before, kSearched);
    expect_same(wrench(pushes, 3.0 * kSpring), {3.0 * before.force, 3.0 * before.torque}, 1e-9);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(0.3 + i, Vector3d(1.0, -2.0, 0.5 + i).normalized()).toRotationMatrix();
    for (Push& p : pushes) {
      p.place = R * p.place + shift;
      p.normal = R * p.normal;
    }
    const Vector3d turned = R * before.force;
    expect_same(wrench(pushes), {turned, R * before.torque + shift.cross(turned)}, kSearched);
  }
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
    expect_near(wrench(pushes).force, {0.0, 0.0, kSpring * shift}, kSearched);
  }
}

TEST(PenaltyForces, AForceThatIsNotFiniteIsRefused) {
  const Push deep = push({0.1, 0.2, 0.3}, {0.0, 0.0, -1.0}, 1e300);
  EXPECT_THROW(penalty_forces({deep}, 1e300), Rejection);
  EXPECT_THROW(penalty_forces({deep, deep}, 1e300), Rejection);
}

TEST(Basins, AContactThatNothingIsKnownOfIsItsOwn) {
  const std::vector<Contact> contacts(3, contact({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.001));
  EXPECT_EQ(basins_of(contacts), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(basins_of({}).empty());
}

TEST(Basins, OtherLinksDoNotCount) {
  Contact far = contact({0.001, 0.0, 0.0}, {0.5, 0.0, -1.0}, 0.001), near = far;
  // The greatest vertex of one face is the least of the other: they are neighbours in sorted lists.
  far.vertices = {1, 2, 3};
  far.barycentric = {0.0, 0.0, 1.0};
  near.vertices = {3, 4, 5};
  near.point.x = 0.0;
  near.barycentric = {0.2, 0.4, 0.4};
  EXPECT_EQ(basins_of({far, near}), (std::vector<std::size_t>{1, 1}));
  near.link = 0;
  EXPECT_EQ(basins_of({far, near}), (std::vector<std::size_t>{0, 1}));
}

TEST(Basins, AWayThatLeadsBackEnds) {
  // From the point of each face, the other one seems nearer. This may happen if the faces were
  // first touched at different times.
  Contact a = contact({0.001, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001), b = a;
  a.vertices = {1, 2, 3};
  b.vertices = {1, 2, 4};
  a.barycentric = {1.0, 0.0, 0.0};
  b.barycentric = {0.0, 1.0, 0.0};
  b.point.x = 0.0;
  b.normal.x = -1.0;
  const std::vector<std::size_t> basins = basins_of({a, b});
  EXPECT_EQ(basins[0], basins[1]);
  EXPECT_EQ(basins[basins[0]], basins[0]);
}

}  // namespace
}  // namespace organ_collision
