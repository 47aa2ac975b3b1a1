#include "contact_adapter/pushes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/messages/failure_log.hpp"
#include "force_trajectory.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// The contact of a shaft with the face z = 0, from above or below. The face is oriented upwards.
Contact at_height(double height) {
  const double side = height < 0.0 ? 1.0 : -1.0;
  Contact flat = contact({0.1, 0.2, 0.0}, {0.0, 0.0, side}, kRadius - std::abs(height));
  flat.on_organ = tf2::toMsg(Vector3d(0.1, 0.2, 0.003));
  flat.behind = height < 0.0;
  flat.shaft = 1.0;
  return flat;
}

/// A contact at the origin with a face of its own.
Contact on_face(std::uint32_t face, const std::array<std::uint32_t, 3>& vertices,
                const Vector3d& normal, double depth) {
  Contact on = contact(Vector3d::Zero(), normal, depth);
  on.face = face;
  std::copy(vertices.begin(), vertices.end(), on.vertices.begin());
  on.shaft = 0.5;
  return on;
}

Push follow(PushTracker& tracker, const Contact& contact, const ShaftRadius& radius = kRadius) {
  const std::vector<Push> pushes = tracker.follow(touched({contact}), radius);
  EXPECT_EQ(pushes.size(), 1u);
  return pushes.at(0);
}

void expect_push(const Push& push, const Vector3d& normal, double depth) {
  EXPECT_LE((push.normal - normal).norm(), 1e-12) << push.normal.transpose();
  EXPECT_NEAR(push.depth, depth, 1e-12);
}
void expect_push(const Push& push, double normal_z, double depth) {
  expect_push(push, {0.0, 0.0, normal_z}, depth);
}

TEST(KeptSides, AStepThroughTheFaceIsKnownByItsDepth) {
  PushTracker tracker;
  Contact through = at_height(0.001);
  through.depth = kRadius + 0.001;
  through.behind = true;
  through.fraction = 0.5;
  expect_push(follow(tracker, through), -1.0, kRadius + 0.001);
  expect_push(follow(tracker, at_height(-0.001)), -1.0, kRadius + 0.001);
}

TEST(KeptSides, WhatIsNotTouchedAnyMoreIsForgotten) {
  PushTracker tracker;
  follow(tracker, at_height(0.001));
  EXPECT_TRUE(tracker.follow(touched({}), kRadius).empty());
  expect_push(follow(tracker, at_height(-0.001)), 1.0, 0.004);
}

TEST(KeptSides, FacesAndLinksAreKeptApart) {
  PushTracker tracker;
  Contact other = at_height(-0.001), jaw = at_height(-0.002);
  other.face = 1;
  jaw.link = 0;
  ContactArray answer = touched({at_height(0.001), other, jaw});
  answer.links = {"jaw"};
  tracker.follow(answer, kRadius);
  const std::vector<Push> pushes = tracker.follow(answer, kRadius);
  expect_push(pushes.at(0), -1.0, 0.004);
  expect_push(pushes.at(1), 1.0, 0.004);
  expect_push(pushes.at(2), 1.0, 0.003);
}

TEST(KeptSides, PastOneSideOfACreaseTheOtherKeepsPushing) {
  const double half = std::sqrt(0.5);
  const Vector3d left(-half, 0.0, -half), right(half, 0.0, -half);
  PushTracker tracker;
  tracker.follow(touched({on_face(0, {0, 1, 2}, left, 0.004), on_face(1, {1, 2, 3}, right, 0.001)}),
                 kRadius);
  // The axis passed the left side. The right one's point is on the edge of the crease, where the
  // left one extends nearer to the axis.
  Contact passed = on_face(0, {0, 1, 2}, -left, 0.004),
          beside = on_face(1, {1, 2, 3}, right, 0.002);
  passed.behind = true;
  passed.point = tf2::toMsg(Vector3d(-0.001 * right));
  beside.barycentric = {0.5, 0.5, 0.0};
  const std::vector<Push> pushes = tracker.follow(touched({passed, beside}), kRadius);
  EXPECT_TRUE(pushes.at(0).counts);
  expect_push(pushes.at(0), left, 0.006);
  EXPECT_TRUE(pushes.at(1).counts);
  expect_push(pushes.at(1), right, 0.002);
}

TEST(KeptSides, OnlyWhatTheTipPiercedIsDeeperThanTheRadius) {
  for (const double shaft : {1.0, 0.5}) {
    PushTracker tracker;
    Contact face = at_height(0.0001);
    face.shaft = shaft;
    face.fraction = 0.5;
    follow(tracker, face);
    face.depth = 0.06;  // of the tip, far beyond the face
    face.fraction = 0.0;
    expect_push(follow(tracker, face), -1.0, shaft == 1.0 ? 0.06 : kRadius);
  }
}

const Vector3d kPlace(0.1, 0.2, 0.3), kWay = Vector3d(0.3, -0.2, 1.0).normalized();

/// The tool is inside, `distance` [m] from the surface, in the direction kWay.
ContactArray inside_at(double distance, const std::vector<Contact>& contacts = {}) {
  ContactArray answer = touched(contacts);
  answer.placement.tip = answer.placement.trocar = ToolPlacement::INSIDE;
  answer.clearance.state = Clearance::KNOWN;
  answer.clearance.distance = distance;
  answer.clearance.on_organ = tf2::toMsg(kPlace);
  answer.clearance.normal = to_vector(kWay);
  answer.clearance.normal_defined = true;
  return answer;
}

/// A tool of one link, without a shaft.
ContactArray link_of(ContactArray answer) {
  answer.links = {"jaw"};
  answer.placement.trocar = ToolPlacement::UNKNOWN;
  answer.clearance.link = 0;
  for (Contact& contact : answer.contacts) contact.link = 0;
  return answer;
}

void expect_push_out(const std::vector<Push>& pushes, double depth) {
  ASSERT_EQ(pushes.size(), 1u);
  expect_push(pushes[0], -kWay, depth);
  EXPECT_EQ(pushes[0].place, kPlace);
  EXPECT_TRUE(pushes[0].counts);
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
    EXPECT_TRUE(PushTracker().follow(other, kRadius).empty()) << other.placement;
  }
  EXPECT_TRUE(PushTracker(false).follow(inside_at(0.002), kRadius).empty());
}

TEST(WayOut, WhileAContactPushesThereIsNoOther) {
  Contact wall = contact({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  EXPECT_EQ(PushTracker().follow(inside_at(-0.001, {wall}), kRadius).size(), 1u);
  wall.depth = 0.011;  // passed in this step, to the outside
  EXPECT_EQ(PushTracker().follow(inside_at(0.002, {wall}), kRadius).size(), 2u);
}

TEST(WayOut, AFaceThatIsTouchedFromInsideKeepsPushingOut) {
  // Otherwise the tool would be pushed back into the organ when it comes up to the surface.
  Contact above = contact(kPlace, kWay, 0.001);
  above.behind = true;
  for (const bool is_first : {true, false}) {
    PushTracker tracker;
    if (!is_first) expect_push_out(tracker.follow(inside_at(0.001), kRadius), 0.011);
    expect_push(tracker.follow(inside_at(-0.001, {above}), kRadius).at(0), -kWay, 0.009);
    above.depth = 0.004;  // It goes on to the surface, and out through it.
    expect_push(tracker.follow(inside_at(-0.004, {above}), kRadius).at(0), -kWay, 0.006);
    above.depth = 0.001;
  }
  ContactArray not_asked = inside_at(-0.001, {above});
  not_asked.clearance = Clearance();
  EXPECT_LE((PushTracker().follow(not_asked, kRadius).at(0).normal - kWay).norm(), 1e-12);
}

TEST(WayOut, OfALinkTheDepthGoesOnFromItsLastContact) {
  PushTracker tracker;
  Contact shallow = contact(kPlace, -kWay, 0.003);
  shallow.face = 1;
  tracker.follow(link_of(inside_at(-0.0, {contact(kPlace, -kWay, 0.017), shallow})), {});
  expect_push_out(tracker.follow(link_of(inside_at(0.0)), {}), 0.017);
  expect_push_out(tracker.follow(link_of(inside_at(0.004)), {}), 0.021);
  // Outside, it is forgotten.
  ContactArray outside = link_of(inside_at(0.001));
  outside.placement.tip = ToolPlacement::OUTSIDE;
  EXPECT_TRUE(tracker.follow(outside, {}).empty());
  expect_push_out(tracker.follow(link_of(inside_at(0.004)), {}), 0.004);
}

TEST(WayOut, ALinkThatIsHalfInsideIsTouchedFromOutside) {
  PushTracker tracker;
  const Contact floor = contact(kPlace, -kWay, 0.003);
  Contact wall = contact(kPlace, {1.0, 0.0, 0.0}, 0.001);
  wall.face = 1;
  tracker.follow(link_of(inside_at(0.0, {floor})), {});
  const auto pushes = tracker.follow(link_of(inside_at(0.0, {floor, wall})), {});
  EXPECT_LE((pushes.at(1).normal - Vector3d::UnitX()).norm(), 1e-12);
}

TEST(WayOut, WithoutAWayThereIsNoForce) {
  const auto refusal = [](const ContactArray& answer) -> std::string {
    try {
      PushTracker().follow(answer, kRadius);
    } catch (const Rejection& rejection) {
      EXPECT_EQ(rejection.reason(), "way out unknown");
      return rejection.what();
    }
    return "accepted";
  };
  std::vector<ContactArray> answers(3, inside_at(0.002));
  answers[0].clearance.state = Clearance::BEYOND_MARGIN;
  answers[0].clearance.margin = 0.02;
  EXPECT_EQ(refusal(answers[0]),
            "the tool is inside the organ and touches nothing; no face is within the margin of "
            "0.02 m, which must be larger than the depth");
  answers[1].clearance.unresolved = true;
  answers[2].clearance.normal_defined = false;
  for (const ContactArray& answer : answers) EXPECT_NE(refusal(answer), "accepted");
}

}  // namespace
}  // namespace organ_collision
