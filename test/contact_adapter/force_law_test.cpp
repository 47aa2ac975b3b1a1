#include "contact_adapter/force_law.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "force_trajectory.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

/// Follows an answer whose contacts push with their own normals and depths.
std::optional<double> follow(ContactMotion& motion, const std::vector<Contact>& contacts,
                             const KeptSides::Radius& radius = kRadius) {
  std::vector<Push> pushes;
  for (const Contact& c : contacts) {
    pushes.push_back({to_eigen(c.end_point), {c.normal.x, c.normal.y, c.normal.z}, c.depth, true});
  }
  return motion.follow(touched(contacts), pushes, radius);
}

Contact of_depth(double depth, const Vector3d& normal = {0.0, 0.0, -1.0}) {
  return contact({0.1, 0.2, 0.3}, normal, depth);
}

}  // namespace

TEST(ContactMotion, ADepthThatChangesIsAWay) {
  ContactMotion motion;
  EXPECT_FALSE(follow(motion, {of_depth(0.001)}));
  EXPECT_NEAR(follow(motion, {of_depth(0.0015)}).value(), 0.0005, 1e-12);
  EXPECT_NEAR(follow(motion, {of_depth(0.0008)}).value(), 0.0007, 1e-12);
  EXPECT_EQ(follow(motion, {of_depth(0.0008)}).value(), 0.0);
}

TEST(ContactMotion, WhatIsNewOrLeftIsAsFarAsItIsDeep) {
  ContactMotion motion;
  EXPECT_FALSE(follow(motion, {}));
  EXPECT_NEAR(follow(motion, {of_depth(0.001)}).value(), 0.001, 1e-12);
  EXPECT_NEAR(follow(motion, {}).value(), 0.001, 1e-12);
}

TEST(ContactMotion, AStabIsAsFarAsTheTipIsBeyond) {
  ContactMotion motion;
  follow(motion, {});
  Contact stab = of_depth(0.06);
  stab.fraction = 0.5;
  EXPECT_NEAR(follow(motion, {stab}).value(), 0.06, 1e-12);
  stab.fraction = 0.0;
  stab.depth = 0.063;
  EXPECT_NEAR(follow(motion, {stab}).value(), 0.003, 1e-12);
}

TEST(ContactMotion, AFaceThatTheAxisCameToLieInIsNoWayOfTheTip) {
  ContactMotion motion;
  follow(motion, {of_depth(kRadius - 0.0001)});
  EXPECT_LE(follow(motion, {of_depth(0.06)}).value(), 0.0001 + 1e-12);
  const Contact beyond = of_depth(0.07);
  const Push side{{0.1, 0.2, 0.3}, {0.0, 0.0, -1.0}, kRadius, true};
  ContactMotion lying;
  lying.follow(touched({of_depth(0.06)}), {side}, kRadius);
  EXPECT_EQ(lying.follow(touched({beyond}), {side}, kRadius).value(), 0.0);
}

TEST(ContactMotion, ANormalThatTurnsIsHalfAWay) {
  // The normal turns about an edge that is 3 mm away.
  ContactMotion motion;
  follow(motion, {of_depth(0.002, {0.0, 0.0, -1.0})});
  const Vector3d turned(std::sin(0.1), 0.0, -std::cos(0.1));
  EXPECT_NEAR(follow(motion, {of_depth(0.002, turned)}).value(), 0.003 * std::sin(0.05), 1e-12);
}

TEST(ContactMotion, OfAnUnknownRadiusOnlyTheDepthShows) {
  ContactMotion motion;
  const Vector3d down(0.0, 0.0, -1.0), turned(0.0, 0.01, -1.0);
  follow(motion, {of_depth(0.002, down)}, std::nullopt);
  EXPECT_NEAR(follow(motion, {of_depth(0.003, turned)}, std::nullopt).value(), 0.001, 1e-12);
  EXPECT_EQ(follow(motion, {of_depth(0.0028, -turned)}, std::nullopt).value(), 0.0);
}

TEST(ContactMotion, OfALinkThatIsPiercedFromTheSideTheDepthIsNoWay) {
  // The normal and the depth of the whole link replace those of the first touch.
  ContactMotion motion;
  follow(motion, {of_depth(0.0001, {1.0, 0.0, 0.0})}, std::nullopt);
  EXPECT_EQ(follow(motion, {of_depth(0.02, {0.0, 0.0, -1.0})}, std::nullopt).value(), 0.0);
  EXPECT_EQ(follow(motion, {}, std::nullopt).value(), 0.0);
  EXPECT_EQ(follow(motion, {of_depth(0.02, {0.0, 0.0, -1.0})}, std::nullopt).value(), 0.0);
  Contact touched_now = of_depth(0.0003);
  touched_now.fraction = 0.4;
  follow(motion, {}, std::nullopt);
  EXPECT_NEAR(follow(motion, {touched_now}, std::nullopt).value(), 0.0003, 1e-12);
  EXPECT_EQ(follow(motion, {of_depth(0.001, {0.0, 0.01, -1.0})}, std::nullopt).value(), 0.0);
}

TEST(ContactMotion, AFaceThatTheShaftPassedAndLeftIsNoWay) {
  ContactMotion motion;
  follow(motion, {});
  follow(motion, {of_depth(0.06)});
  EXPECT_EQ(follow(motion, {}).value(), 0.0);
}

TEST(ContactMotion, AClearanceThatChangesIsAWay) {
  ContactArray answer = touched({});
  answer.clearance.state = Clearance::KNOWN;
  ContactMotion motion;
  std::vector<double> ways;
  for (const double distance : {0.02, 0.0207, 0.0198, 0.0198}) {
    answer.clearance.distance = distance;
    ways.push_back(motion.follow(answer, {}, kRadius).value_or(-1.0));
  }
  EXPECT_EQ(ways[0], -1.0);
  EXPECT_NEAR(ways[1], 0.0007, 1e-12);
  EXPECT_NEAR(ways[2], 0.0009, 1e-12);
  EXPECT_EQ(ways[3], 0.0);
  answer.clearance.distance = 0.5;
  answer.clearance.unresolved = true;
  EXPECT_EQ(motion.follow(answer, {}, kRadius).value(), 0.0);
  answer.clearance.unresolved = false;
  answer.clearance.state = Clearance::BEYOND_MARGIN;
  EXPECT_EQ(motion.follow(answer, {}, kRadius).value(), 0.0);
}

TEST(ContactMotion, AStaticAnswerAndAnotherTopologyBeginAnew) {
  ContactMotion motion;
  follow(motion, {});
  ContactArray answer = touched({});
  answer.topology = 1;
  EXPECT_FALSE(motion.follow(answer, {}, kRadius));
  EXPECT_TRUE(motion.follow(answer, {}, kRadius));
  answer.mode = ContactArray::STATIC;
  EXPECT_FALSE(motion.follow(answer, {}, kRadius));
}

TEST(ContactMotion, IsNoMoreThanTheWayOfRealQueries) {
  const TriangleMesh organ = grid_mesh(24, 24, [](double u, double v) -> Vector3d {
    const double x = 0.06 * u - 0.0297, y = 0.06 * v - 0.0302;
    return {x, y, (x * x - y * y) / 0.06};
  });
  for (const double yaw : {0.0, 0.7, 1.5}) {
    const auto at = [&](double z) {
      const Vector3d along(std::sin(yaw), std::cos(yaw), -0.02), middle(0.0, 0.001, z);
      return ShaftAxis{middle - 0.05 * along, middle + 0.02 * along};
    };
    KeptSides sides;
    ContactMotion motion;
    std::vector<double> ways;
    const auto steps = forces_along(
        way_through({at(0.015), at(-0.003), at(0.015)}, 1e-4), organ, [&](const ContactArray& a) {
          ways.push_back(motion.follow(a, sides.follow(a, kRadius), kRadius).value_or(0.0));
          return Vector3d::Zero();
        });
    double sum = 0.0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      EXPECT_LE(ways[i], 1.01 * steps[i].way) << "yaw " << yaw << ", step " << i;
      sum += ways[i];
    }
    EXPECT_GE(sum, 0.01) << "yaw " << yaw;  // [m] The tool moves by 36 mm.
  }
}

using namespace organ_collision;

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
