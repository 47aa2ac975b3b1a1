#include "contact_adapter/force_law.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "contact_arrays.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kRadius = 0.005;      // [m]
constexpr double kStiffness = 1000.0;  // [N/m]
constexpr double kSeconds = 0.001;     // [s]

Contact floor_at(double depth) { return contact({0.09, 0.0, 0.0}, {0.0, 0.0, -1.0}, depth); }

/// A contact with a wall, whose push counts.
Contact wall_at(double depth) {
  Contact wall = contact({0.1, 0.0, 0.3}, {1.0, 0.0, 0.0}, depth);
  wall.face = 1;
  wall.vertices = {3, 4, 5};
  wall.end_point = wall.point;
  return wall;
}

/// A contact with the wall whose push does not count: the wall's nearest corner also belongs to the
/// floor, which is nearer to the tool.
Contact hidden_wall(double depth) {
  Contact wall = wall_at(depth);
  wall.vertices = {2, 4, 5};
  wall.barycentric = {1.0, 0.0, 0.0};
  return wall;
}

ContactArray answer_of(const std::vector<Contact>& contacts) {
  ContactArray answer = touched(contacts);
  answer.contacts[0].vertices = {0, 1, 2};
  return answer;
}

Vector3d force(ForceLaw& law, const ContactArray& answer, double seconds = kSeconds) {
  return to_eigen(wrench_of(law.follow(answer, seconds, kStiffness, kRadius)).force);
}

void expect_near(const Vector3d& found, const Vector3d& expected) {
  EXPECT_LE((found - expected).norm(), 1e-9)
      << found.transpose() << " instead of " << expected.transpose();
}

}  // namespace

TEST(ForceLaw, ADepthThatGrowsIsFollowedAtOnce) {
  ForceLaw law;
  force(law, touched({}));
  for (const double depth : {0.0001, 0.002, 0.003, 0.0005}) {
    expect_near(force(law, answer_of({floor_at(depth)}), 0.0), {0.0, 0.0, kStiffness * depth});
  }
}

TEST(ForceLaw, ASpringThatAppearsIsFollowedByTheWayAndTheTime) {
  const Vector3d up(0.0, 0.0, 0.003 * kStiffness), left(-0.002 * kStiffness, 0.0, 0.0);
  ForceLaw law;
  expect_near(force(law, answer_of({floor_at(0.003), hidden_wall(0.002)})), up);
  const ContactArray appeared = answer_of({floor_at(0.003), wall_at(0.002)});
  for (int step = 1; step <= 40; ++step) {
    // While the tool rests, the force changes by stiffness * 0.05 mm each millisecond.
    expect_near(force(law, appeared), up + std::min(1.0, 0.025 * step) * left);
  }
  expect_near(force(law, answer_of({floor_at(0.003), hidden_wall(0.002)}), 0.0), up + left);
  const Vector3d moved = force(law, answer_of({floor_at(0.0031), hidden_wall(0.002)}), 0.0);
  const Vector3d back = Vector3d(0.0, 0.0, 0.0031 * kStiffness) - (up + left);
  expect_near(moved, up + left + 4.0 * kStiffness * 0.0001 * back.normalized());
}

TEST(ForceLaw, TheTorqueFollowsInTheSameShare) {
  ForceLaw law;
  const ContactArray hidden = answer_of({floor_at(0.003), hidden_wall(0.002)});
  const auto before = wrench_of(law.follow(hidden, kSeconds, kStiffness, kRadius));
  const ContactArray appeared = answer_of({floor_at(0.003), wall_at(0.002)});
  const auto half = wrench_of(law.follow(appeared, 0.02, kStiffness, kRadius));
  const auto whole = wrench_of(law.follow(appeared, 1.0, kStiffness, kRadius));
  EXPECT_NEAR(half.force.x, 0.5 * (before.force.x + whole.force.x), 1e-9);
  EXPECT_NEAR(half.torque.y, 0.5 * (before.torque.y + whole.torque.y), 1e-9);
  EXPECT_GT(std::abs(whole.torque.y - before.torque.y), 0.1);
}

TEST(ForceLaw, WhatBeginsAnewHasNoLimit) {
  const Vector3d left(-0.002 * kStiffness, 0.0, 0.0), up(0.0, 0.0, 0.003 * kStiffness);
  ContactArray appeared = answer_of({floor_at(0.003), wall_at(0.002)});
  ForceLaw law;
  force(law, answer_of({floor_at(0.003), hidden_wall(0.002)}));
  appeared.topology = 1;
  expect_near(force(law, appeared, 0.0), up + left);
  appeared = answer_of({floor_at(0.003), hidden_wall(0.002)});
  appeared.mode = ContactArray::STATIC;
  expect_near(force(law, appeared, 0.0), up);
}

TEST(ForceLaw, WithoutContactsItIsZeroAtOnce) {
  ForceLaw law;
  force(law, answer_of({floor_at(0.003), wall_at(0.002)}));
  expect_near(force(law, touched({}), 0.0), Vector3d::Zero());
}

TEST(ForceLaw, LinksThatShareAFaceAreOneSpring) {
  // Both contacts lie on one face. Their spring has the larger depth and acts between them.
  Contact left = floor_at(0.001), right = floor_at(0.003);
  left.end_point = tf2::toMsg(Eigen::Vector3d(0.0, 0.0, 0.0));
  right.end_point = tf2::toMsg(Eigen::Vector3d(0.04, 0.0, 0.0));
  right.link = 1;
  ContactArray answer = touched({left, right});
  answer.links = {"left_jaw", "right_jaw"};
  ForceLaw law;
  const auto wrench = wrench_of(law.follow(answer, kSeconds, kStiffness, std::nullopt));
  EXPECT_NEAR(wrench.force.z, 3.0, 1e-9);
  EXPECT_NEAR(wrench.torque.y, -3.0 * 0.03, 1e-9);
}

TEST(ForceLaw, OfLinksTheForceDoesNotJumpEither) {
  ForceLaw law;
  ContactArray hidden = answer_of({floor_at(0.003), hidden_wall(0.002)});
  ContactArray appeared = answer_of({floor_at(0.003), wall_at(0.002)});
  hidden.links = appeared.links = {"jaw"};
  const Vector3d before = force(law, hidden);
  EXPECT_NEAR((force(law, appeared) - before).norm(), 0.05 * kSeconds * kStiffness, 1e-9);
}
