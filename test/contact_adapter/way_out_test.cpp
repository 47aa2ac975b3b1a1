#include "contact_adapter/way_out.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "contact_arrays.hpp"
#include "ros/interface/rejection.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kRadius = 0.005;  // [m]
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
