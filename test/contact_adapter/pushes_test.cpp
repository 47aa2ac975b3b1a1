#include "contact_adapter/pushes.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "force_trajectory.hpp"
#include "ros/messages/failure_log.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kRadius = 0.005;  // [m]

/// The contact of a shaft with the face z = 0, from above or below. The face is oriented upwards.
Contact at_height(double height) {
  const double side = height < 0.0 ? 1.0 : -1.0;
  Contact flat = contact({0.1, 0.2, 0.0}, {0.0, 0.0, side}, kRadius - std::abs(height));
  flat.end_point = tf2::toMsg(Eigen::Vector3d(0.1, 0.2, 0.003));
  flat.behind = height < 0.0;
  flat.shaft = 1.0;
  return flat;
}

Push follow(KeptSides& sides, const Contact& contact, const KeptSides::Radius& radius = kRadius) {
  const std::vector<Push> pushes = sides.follow(touched({contact}), radius);
  EXPECT_EQ(pushes.size(), 1u);
  return pushes.at(0);
}

void expect_push(const Push& push, double normal_z, double depth) {
  EXPECT_LE((push.normal - Vector3d(0.0, 0.0, normal_z)).norm(), 1e-12) << push.normal.transpose();
  EXPECT_NEAR(push.depth, depth, 1e-12);
}

}  // namespace

TEST(KeptSides, APushIsTheContactsAtTheEndOfTheStep) {
  KeptSides sides;
  const Push push = follow(sides, at_height(0.002));
  expect_push(push, -1.0, 0.003);
  EXPECT_EQ(push.place, Vector3d(0.1, 0.2, 0.003));
  EXPECT_TRUE(push.counts);
}

TEST(KeptSides, PastTheFaceTheSideStaysAndTheDepthGrows) {
  KeptSides sides;
  for (const double height : {0.001, -0.001, -0.003, -0.004, -0.002, 0.002}) {
    expect_push(follow(sides, at_height(height)), -1.0, kRadius - height);
  }
}

TEST(KeptSides, TouchedFromInsideTheToolIsPushedIn) {
  KeptSides sides;
  for (const double height : {-0.001, 0.001, 0.003, -0.002}) {
    expect_push(follow(sides, at_height(height)), 1.0, kRadius + height);
  }
}

TEST(KeptSides, AStepThroughTheFaceIsKnownByItsDepth) {
  KeptSides sides;
  Contact through = at_height(0.001);
  through.depth = kRadius + 0.001;
  through.behind = true;
  through.fraction = 0.5;
  expect_push(follow(sides, through), -1.0, kRadius + 0.001);
  expect_push(follow(sides, at_height(-0.001)), -1.0, kRadius + 0.001);
}

TEST(KeptSides, WhatIsNotTouchedAnyMoreIsForgotten) {
  KeptSides sides;
  follow(sides, at_height(0.001));
  EXPECT_TRUE(sides.follow(touched({}), kRadius).empty());
  expect_push(follow(sides, at_height(-0.001)), 1.0, 0.004);
}

TEST(KeptSides, AStaticAnswerAndAnotherTopologyBeginAnew) {
  KeptSides sides;
  follow(sides, at_height(0.001));
  ContactArray answer = touched({at_height(-0.001)});
  answer.mode = ContactArray::STATIC;
  expect_push(sides.follow(answer, kRadius).at(0), 1.0, 0.004);
  answer = touched({at_height(0.001)});
  answer.topology = 1;
  expect_push(sides.follow(answer, kRadius).at(0), -1.0, 0.004);
}

TEST(KeptSides, FacesAndLinksAreKeptApart) {
  KeptSides sides;
  Contact other = at_height(-0.001);
  other.face = 1;
  Contact jaw = at_height(-0.002);
  jaw.link = 1;
  ContactArray answer = touched({at_height(0.001), other, jaw});
  answer.links = {"", "jaw"};
  sides.follow(answer, kRadius);
  const std::vector<Push> pushes = sides.follow(answer, kRadius);
  expect_push(pushes.at(0), -1.0, 0.004);
  expect_push(pushes.at(1), 1.0, 0.004);
  expect_push(pushes.at(2), 1.0, 0.003);
}

TEST(KeptSides, OfAnUnknownRadiusTheDepthStaysPastTheFace) {
  KeptSides sides;
  expect_push(follow(sides, at_height(0.001), std::nullopt), -1.0, 0.004);
  expect_push(follow(sides, at_height(-0.002), std::nullopt), -1.0, 0.004);
  expect_push(follow(sides, at_height(0.002), std::nullopt), -1.0, 0.003);
}

TEST(KeptSides, OfALinkTheDepthGrowsOnPastTheFaceAsItChanges) {
  KeptSides sides;
  for (const double height : {0.001, 0.0001, -0.0001, -0.003, -0.0049, -0.002, 0.002}) {
    expect_push(follow(sides, at_height(height), std::nullopt), -1.0,
                height > 0.0 ? kRadius - height : kRadius - height - 0.0002);
  }
}

TEST(KeptSides, TouchedFromInsideByALinkThatWasInsideItIsPushedOut) {
  // It goes on out through the face. Its last push inside had twice the radius as depth.
  for (const KeptSides::Radius& radius : {KeptSides::Radius(kRadius), KeptSides::Radius()}) {
    KeptSides sides;
    const KeptSides::DepthsInside inside = {{0, 2.0 * kRadius}};
    const auto push = sides.follow(touched({at_height(-0.0049)}), radius, inside).at(0);
    expect_push(push, -1.0, kRadius + 0.0049);
    for (const double height : {-0.003, -0.0001, 0.0001, 0.003}) {
      expect_push(sides.follow(touched({at_height(height)}), radius).at(0), -1.0, kRadius - height);
    }
  }
}

TEST(KeptSides, OnlyWhatTheTipPiercedIsDeeperThanTheRadius) {
  for (const double shaft : {1.0, 0.5}) {
    KeptSides sides;
    Contact face = at_height(0.0001);
    face.shaft = shaft;
    face.fraction = 0.5;
    follow(sides, face);
    face.depth = 0.06;  // of the tip, far beyond the face
    face.fraction = 0.0;
    expect_push(follow(sides, face), -1.0, shaft == 1.0 ? 0.06 : kRadius);
  }
}

using namespace organ_collision;

namespace {

const Vector3d kPlace(0.1, 0.2, 0.3), kWay = Vector3d(0.3, -0.2, 1.0).normalized();

/// The tool is inside, `distance` [m] from the surface, in the direction kWay.
ContactArray inside_at(double distance, const std::vector<Contact>& contacts = {}) {
  ContactArray answer = touched(contacts);
  answer.placement.tip = answer.placement.trocar = ToolPlacement::INSIDE;
  answer.clearance.state = Clearance::KNOWN;
  answer.clearance.distance = distance;
  answer.clearance.on_organ = tf2::toMsg(Eigen::Vector3d(kPlace));
  answer.clearance.normal = to_vector(kWay);
  answer.clearance.normal_defined = true;
  return answer;
}

/// A tool of one link, without a shaft.
ContactArray link_of(ContactArray answer) {
  answer.links = {"jaw"};
  answer.placement.trocar = ToolPlacement::UNKNOWN;
  return answer;
}

void expect_push_out(const std::vector<Push>& pushes, double depth) {
  ASSERT_EQ(pushes.size(), 1u);
  EXPECT_LE((pushes[0].normal + kWay).norm(), 1e-12);
  EXPECT_NEAR(pushes[0].depth, depth, 1e-12);
  EXPECT_EQ(pushes[0].place, kPlace);
  EXPECT_TRUE(pushes[0].counts);
}

std::string refusal(const ContactArray& answer) {
  try {
    WayOut().follow(answer, kRadius);
  } catch (const Rejection& rejection) {
    EXPECT_EQ(rejection.reason(), "way out unknown");
    return rejection.what();
  }
  return "accepted";
}

}  // namespace

TEST(WayOut, AShaftInsideIsPushedAsDeepAsItMustMove) {
  WayOut way_out;
  for (const double distance : {0.0, 0.002, 0.03, 0.001}) {
    expect_push_out(way_out.follow(inside_at(distance), kRadius), 2.0 * kRadius + distance);
  }
}

TEST(WayOut, OnlyAToolThatIsKnownToBeInsideIsPushed) {
  std::vector<ContactArray> others(6, inside_at(0.002));
  others[0].placement.tip = ToolPlacement::OUTSIDE;
  others[1].placement.tip = ToolPlacement::UNKNOWN;
  others[2].placement.trocar = ToolPlacement::OUTSIDE;
  others[3].placement.trocar = ToolPlacement::UNKNOWN;
  others[4].placement.crossings.resize(2);
  others[5].clearance.state = Clearance::NOT_ASKED;
  for (const ContactArray& other : others) {
    EXPECT_TRUE(WayOut().follow(other, kRadius).empty()) << other.placement;
  }
  EXPECT_TRUE(WayOut(false).follow(inside_at(0.002), kRadius).empty());
}

TEST(WayOut, WhileAContactPushesThereIsNoOther) {
  Contact wall = contact({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  EXPECT_EQ(WayOut().follow(inside_at(-0.001, {wall}), kRadius).size(), 1u);
  wall.depth = 0.011;  // passed in this step, to the outside
  EXPECT_EQ(WayOut().follow(inside_at(0.002, {wall}), kRadius).size(), 2u);
}

TEST(WayOut, AFaceThatIsTouchedFromInsideKeepsPushingOut) {
  // Otherwise the tool would be pushed back into the organ when it comes up to the surface.
  Contact above = contact(kPlace, kWay, 0.001);
  above.behind = true;
  for (const bool is_first : {true, false}) {
    WayOut way_out;
    if (!is_first) expect_push_out(way_out.follow(inside_at(0.001), kRadius), 0.011);
    const auto pushes = way_out.follow(inside_at(-0.001, {above}), kRadius);
    ASSERT_EQ(pushes.size(), 1u);
    EXPECT_LE((pushes[0].normal + kWay).norm(), 1e-12);
    EXPECT_NEAR(pushes[0].depth, 0.009, 1e-12);
  }
}

TEST(WayOut, WithoutAClearanceAFaceTouchedFromInsidePushesIn) {
  ContactArray answer = inside_at(-0.001, {contact(kPlace, kWay, 0.001)});
  answer.clearance = Clearance();
  const auto pushes = WayOut().follow(answer, kRadius);
  EXPECT_LE((pushes.at(0).normal - kWay).norm(), 1e-12);
}

TEST(WayOut, OfALinkTheDepthGoesOnFromItsLastContact) {
  WayOut way_out;
  way_out.follow(link_of(inside_at(-0.0, {contact(kPlace, -kWay, 0.017)})), {});
  expect_push_out(way_out.follow(link_of(inside_at(0.0)), {}), 0.017);
  expect_push_out(way_out.follow(link_of(inside_at(0.004)), {}), 0.021);
  // Outside, it is forgotten.
  ContactArray outside = link_of(inside_at(0.001));
  outside.placement.tip = ToolPlacement::OUTSIDE;
  EXPECT_TRUE(way_out.follow(outside, {}).empty());
  expect_push_out(way_out.follow(link_of(inside_at(0.004)), {}), 0.004);
}

TEST(WayOut, ALinkThatIsHalfInsideIsTouchedFromOutside) {
  WayOut way_out;
  const Contact floor = contact(kPlace, -kWay, 0.003);
  Contact wall = contact(kPlace, {1.0, 0.0, 0.0}, 0.001);
  wall.face = 1;
  way_out.follow(link_of(inside_at(0.0, {floor})), {});
  const auto pushes = way_out.follow(link_of(inside_at(0.0, {floor, wall})), {});
  EXPECT_LE((pushes.at(1).normal - Vector3d::UnitX()).norm(), 1e-12);
}

TEST(WayOut, WhatBeginsAnewRemembersNoDepth) {
  for (const bool is_static : {true, false}) {
    WayOut way_out;
    way_out.follow(link_of(inside_at(0.0, {contact(kPlace, -kWay, 0.017)})), {});
    ContactArray anew = link_of(inside_at(0.004));
    is_static ? anew.mode = ContactArray::STATIC : anew.topology = 1;
    expect_push_out(way_out.follow(anew, {}), 0.004);
  }
}

TEST(WayOut, WithoutAWayThereIsNoForce) {
  ContactArray answer = inside_at(0.0);
  answer.clearance.state = Clearance::BEYOND_MARGIN;
  answer.clearance.margin = 0.02;
  EXPECT_EQ(
      refusal(answer),
      "the tool is inside the organ and touches nothing; no face is within the margin of 0.02 "
      "m, which must be larger than the depth");
  answer = inside_at(0.002);
  answer.clearance.unresolved = true;
  EXPECT_NE(refusal(answer), "accepted");
  answer = inside_at(0.002);
  answer.clearance.normal_defined = false;
  EXPECT_NE(refusal(answer), "accepted");
}
