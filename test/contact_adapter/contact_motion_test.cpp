#include "contact_adapter/contact_motion.hpp"

#include <gtest/gtest.h>

#include "contact_arrays.hpp"
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
