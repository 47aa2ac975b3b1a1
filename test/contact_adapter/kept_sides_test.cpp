#include "contact_adapter/kept_sides.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "contact_arrays.hpp"

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
