#include "penalty_wrench.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "contact_arrays.hpp"
#include "organ_collision/ros/rejection.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kStiffness = 250.0;

struct Wrench {
  Vector3d force, torque;
};

Wrench wrench(const std::vector<Contact>& contacts, double stiffness = kStiffness) {
  const auto w = penalty_wrench(touched(contacts), stiffness).wrench;
  return {{w.force.x, w.force.y, w.force.z}, {w.torque.x, w.torque.y, w.torque.z}};
}

void expect_near(const Vector3d& found, const Vector3d& expected, double tolerance = 1e-12) {
  EXPECT_LE((found - expected).norm(), tolerance)
      << found.transpose() << " instead of " << expected.transpose();
}

void expect_same(const Wrench& found, const Wrench& expected, double tolerance = 1e-12) {
  expect_near(found.force, expected.force, tolerance);
  expect_near(found.torque, expected.torque, tolerance);
}

/// Depth and normal of a ball's contact with a point; there must be one.
Contact ball_contact(const Vector3d& center, double radius, const Vector3d& point) {
  const Vector3d way = point - center;
  return contact(point, way, radius - way.norm());
}

/// A ball, its centre `height` above flat tissue at z = 0 that is divided into squares of `edge`:
/// one contact for each that it touches, at the square's nearest point.
std::vector<Contact> ball_on_squares(const Vector3d& center, double radius, double edge) {
  std::vector<Contact> contacts;
  const int reach = static_cast<int>(std::ceil(radius / edge)) + 1;
  const int first_x = static_cast<int>(std::floor(center.x() / edge)) - reach;
  const int first_y = static_cast<int>(std::floor(center.y() / edge)) - reach;
  for (int i = first_x; i <= first_x + 2 * reach; ++i) {
    for (int j = first_y; j <= first_y + 2 * reach; ++j) {
      const Vector3d point(std::clamp(center.x(), i * edge, (i + 1) * edge),
                           std::clamp(center.y(), j * edge, (j + 1) * edge), 0.0);
      if ((point - center).norm() <= radius)
        contacts.push_back(ball_contact(center, radius, point));
    }
  }
  return contacts;
}

/// Contacts as they may come: scattered places, normals all around, some left.
std::vector<Contact> scattered_contacts(std::mt19937& random, int count) {
  std::normal_distribution<double> number(0.0, 0.01);
  std::vector<Contact> contacts;
  for (int i = 0; i < count; ++i) {
    const Vector3d point(number(random), number(random), number(random));
    const Vector3d normal(number(random), number(random), number(random));
    contacts.push_back(contact(point, normal, number(random)));
  }
  return contacts;
}

}  // namespace

TEST(PenaltyWrench, OneContactIsASpring) {
  const Wrench found = wrench({contact({0.1, 0.2, 0.3}, {0.0, 0.0, -1.0}, 0.004)});
  expect_near(found.force, {0.0, 0.0, 1.0});  // 250 N/m * 4 mm, against the normal
  expect_near(found.torque, {0.2, -0.1, 0.0});
}

TEST(PenaltyWrench, HeaderIsTheContacts) {
  const auto found = penalty_wrench(touched({}), kStiffness);
  EXPECT_EQ(found.header.frame_id, "liver");
  EXPECT_EQ(found.header.stamp, ros::Time(3, 7));
}

TEST(PenaltyWrench, NothingTouchedOrAllLeftIsZero) {
  expect_same(wrench({}), {Vector3d::Zero(), Vector3d::Zero()}, 0.0);
  const Contact left = contact({0.1, 0.2, 0.3}, {1.0, 0.5, 0.0}, -0.002);
  const Contact grazed = contact({0.1, 0.2, 0.3}, {1.0, 0.5, 0.0}, 0.0);
  expect_same(wrench({left, grazed}), {Vector3d::Zero(), Vector3d::Zero()}, 0.0);
}

TEST(PenaltyWrench, WhatWasLeftDoesNotCount) {
  const Contact deep = contact({0.1, 0.2, 0.3}, {0.3, 0.5, -1.0}, 0.004);
  const Contact left = contact({0.12, 0.2, 0.29}, {1.0, 0.5, 0.0}, -0.05);
  expect_same(wrench({left, deep}), wrench({deep}), 0.0);
}

TEST(PenaltyWrench, FlatTissueIsOneSpringHoweverItIsDivided) {
  const double radius = 0.005;
  for (const double height : {0.0049, 0.003, 0.001, 1e-5}) {
    for (const double edge : {0.5, 0.004, 0.001, 0.00013}) {
      const auto contacts = ball_on_squares({0.0207, 0.0111, height}, radius, edge);
      ASSERT_FALSE(contacts.empty());
      expect_near(wrench(contacts).force, {0.0, 0.0, kStiffness * (radius - height)});
    }
  }
}

TEST(PenaltyWrench, APiercedFaceOutweighsTheFacesAroundTheHole) {
  // The tip is 7 mm below the sheet, the shaft leans; beside it, faces are touched from the side.
  const Vector3d along = Vector3d(0.5, 0.0, -1.0).normalized(),
                 side = along.cross(Vector3d::UnitY());
  std::vector<Contact> contacts = {contact({0.02, 0.01, 0.0}, {0.0, 0.0, -1.0}, 0.012)};
  const Wrench pierced = wrench(contacts);
  for (const double sign : {-1.0, 1.0}) {
    contacts.push_back(contact({0.02 + 0.001 * sign, 0.01, 0.0}, -sign * side, 0.0045));
    contacts.push_back(contact({0.02, 0.01 + 0.001 * sign, 0.0}, {0.0, sign, 0.0}, 0.004));
  }
  expect_near(wrench(contacts).force, pierced.force);
  expect_near(pierced.force, {0.0, 0.0, kStiffness * 0.012});
}

TEST(PenaltyWrench, SplittingSomeFacesMoreThanOthersChangesNoForce) {
  // Between two walls and a floor, each split in its plane.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> way(-0.002, 0.002);
  const std::vector<Contact> whole = {contact({0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.0011),
                                      contact({-0.003, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 0.0023),
                                      contact({0.0, 0.0, -0.004}, {0.0, 0.2, -1.0}, 0.0009)};
  for (int i = 0; i < 50; ++i) {
    std::vector<Contact> split;
    for (const Contact& face : whole) {
      const Vector3d normal(face.normal.x, face.normal.y, face.normal.z);
      const Vector3d across = normal.unitOrthogonal();
      const int pieces = 1 + static_cast<int>(random() % 40);
      for (int piece = 0; piece < pieces; ++piece) {
        const Vector3d inside = way(random) * across + way(random) * normal.cross(across);
        split.push_back(face);
        split.back().point = to_point(to_eigen(face.point) + inside);
      }
    }
    expect_near(wrench(split).force, wrench(whole).force);
  }
}

TEST(PenaltyWrench, SplittingAllFacesAlikeChangesNothing) {
  std::mt19937 random(4);
  for (int i = 0; i < 50; ++i) {
    const std::vector<Contact> whole = scattered_contacts(random, 10);
    std::vector<Contact> split;
    for (int piece = 0; piece < 5; ++piece) split.insert(split.end(), whole.begin(), whole.end());
    expect_same(wrench(split), wrench(whole));
  }
}

TEST(PenaltyWrench, OrderDoesNotMatter) {
  std::mt19937 random(6);
  for (int i = 0; i < 50; ++i) {
    std::vector<Contact> contacts = scattered_contacts(random, 10);
    contacts[3].depth = contacts[4].depth = contacts[5].depth = 0.02;
    const Wrench expected = wrench(contacts);
    std::shuffle(contacts.begin(), contacts.end(), random);
    expect_same(wrench(contacts), expected, 1e-15);
  }
}

TEST(PenaltyWrench, TurnsWithTheContacts) {
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    std::vector<Contact> contacts = scattered_contacts(random, 10);
    const Wrench before = wrench(contacts);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(0.3 + i, Vector3d(1.0, -2.0, 0.5 + i).normalized()).toRotationMatrix();
    for (Contact& c : contacts) {
      c.point = to_point(R * to_eigen(c.point));
      c.normal = to_vector(R * Vector3d(c.normal.x, c.normal.y, c.normal.z));
    }
    expect_same(wrench(contacts), {R * before.force, R * before.torque}, 1e-12);
  }
}

TEST(PenaltyWrench, MovedContactsAddTheLeverAlone) {
  std::mt19937 random(8);
  const Vector3d shift(0.3, -0.2, 0.1);
  std::vector<Contact> contacts = scattered_contacts(random, 10);
  const Wrench before = wrench(contacts);
  for (Contact& c : contacts) c.point = to_point(to_eigen(c.point) + shift);
  expect_same(wrench(contacts), {before.force, before.torque + shift.cross(before.force)}, 1e-12);
}

TEST(PenaltyWrench, IsProportionalToTheStiffness) {
  std::mt19937 random(9);
  const std::vector<Contact> contacts = scattered_contacts(random, 10);
  const Wrench soft = wrench(contacts, 1.0);
  expect_same(wrench(contacts, 800.0), {800.0 * soft.force, 800.0 * soft.torque}, 1e-12);
}

TEST(PenaltyWrench, OppositeEqualContactsCancel) {
  const Contact right = contact({0.004, 0.01, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  const Contact left = contact({-0.004, 0.01, 0.0}, {-1.0, 0.0, 0.0}, 0.001);
  expect_same(wrench({right, left}), {Vector3d::Zero(), Vector3d::Zero()});
}

TEST(PenaltyWrench, OppositeWallsAreSpringsOfTheirOwn) {
  const Contact right = contact({0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  const Contact left = contact({-0.002, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 0.003);
  expect_near(wrench({right, left}).force, {kStiffness * 0.002, 0.0, 0.0});
}

TEST(PenaltyWrench, OppositePushesAtTwoPlacesTurnTheTool) {
  const Contact right = contact({0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  const Contact left = contact({-0.004, 0.0, 0.1}, {-1.0, 0.0, 0.0}, 0.001);
  const Wrench found = wrench({right, left});
  expect_near(found.force, Vector3d::Zero());
  expect_near(found.torque, {0.0, kStiffness * 0.001 * 0.1, 0.0});
}

TEST(PenaltyWrench, WallsAtRightAnglesAreSpringsOfTheirOwn) {
  const Contact wall = contact({0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  const Contact floor = contact({0.0, 0.0, -0.003}, {0.0, 0.0, -1.0}, 0.002);
  expect_near(wrench({wall, floor}).force, {-kStiffness * 0.001, 0.0, kStiffness * 0.002});
}

TEST(PenaltyWrench, InACreaseTheForceIsOfTheSmallestShiftThatLeavesBothSides) {
  // Both sides rise by 30 degrees; the ball has to rise by depth / cos(30 degrees).
  const double radius = 0.005, depth = 0.001, angle = M_PI / 6.0;
  const Vector3d a(std::sin(angle), 0.0, -std::cos(angle)), b(-a.x(), 0.0, a.z());
  const std::vector<Contact> sides = {contact((radius - depth) * a, a, depth),
                                      contact((radius - depth) * b, b, depth)};
  expect_near(wrench(sides).force, {0.0, 0.0, kStiffness * depth / std::cos(angle)});
}

TEST(PenaltyWrench, InADentOfTheToolsShapeTheForceIsOneContacts) {
  // A half ball pressed down by `shift`: depths are its share along each normal. To 1 %: of
  // contacts equally deep, the first hides a little of the next.
  const double radius = 0.005, shift = 0.0002;
  for (const int rings : {2, 5, 20}) {
    std::vector<Contact> contacts = {contact({0.0, 0.0, -radius}, {0.0, 0.0, -1.0}, shift)};
    for (int ring = 1; ring < rings; ++ring) {
      const double polar = 0.5 * M_PI * ring / rings;
      for (int k = 0; k < 6 * ring; ++k) {
        const double azimuth = 2.0 * M_PI * k / (6 * ring);
        const Vector3d normal(std::sin(polar) * std::cos(azimuth),
                              std::sin(polar) * std::sin(azimuth), -std::cos(polar));
        contacts.push_back(contact(radius * normal, normal, shift * std::cos(polar)));
      }
    }
    expect_near(wrench(contacts).force, {0.0, 0.0, kStiffness * shift}, 0.01 * kStiffness * shift);
  }
}

TEST(PenaltyWrench, AShaftThatLiesOnTheTissueIsPushedAtItsMiddle) {
  std::vector<Contact> contacts;
  for (int i = 0; i <= 10; ++i)
    contacts.push_back(contact({0.01 * i, 0.0, 0.0}, {0, 0, -1}, 0.001));
  const Wrench found = wrench(contacts);
  expect_near(found.force, {0.0, 0.0, 0.25});
  expect_near(found.torque, {0.0, -0.05 * 0.25, 0.0});
}

TEST(PenaltyWrench, LinksThatTouchTheSameFaceAreOneSpring) {
  // A wrist 2 mm and a jaw 1 mm deep in flat tissue, in any order.
  std::vector<Contact> contacts = {contact({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.002),
                                   contact({0.01, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.001)};
  for (const std::uint32_t jaw : {1u, 0u}) {
    contacts[jaw].link = 1;
    expect_near(wrench(contacts).force, {0.0, 0.0, kStiffness * 0.002});
    std::swap(contacts[0], contacts[1]);
  }
}

TEST(PenaltyWrench, ALinkThatCoversAnotherAddsNothing) {
  std::mt19937 random(10);
  for (int i = 0; i < 50; ++i) {
    std::vector<Contact> contacts = scattered_contacts(random, 10);
    const Wrench alone = wrench(contacts);
    for (std::size_t k = 0; k < 10; ++k) {
      contacts.push_back(contacts[k]);
      contacts.back().link = 1;
    }
    expect_same(wrench(contacts), alone);
  }
}

TEST(PenaltyWrench, JawsThatCloseOnTissueAreSpringsOfTheirOwn) {
  Contact left = contact({-0.004, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001);
  Contact right = contact({0.004, 0.0, 0.02}, {-1.0, 0.0, 0.0}, 0.003);
  right.link = 1;
  const Wrench found = wrench({left, right});
  expect_near(found.force, {kStiffness * 0.002, 0.0, 0.0});
  expect_near(found.torque, {0.0, kStiffness * 0.003 * 0.02, 0.0});
}

TEST(PenaltyWrench, AForceThatIsNotFiniteIsRefused) {
  const Contact deep = contact({0.1, 0.2, 0.3}, {0.0, 0.0, -1.0}, 1e300);
  EXPECT_THROW(penalty_wrench(touched({deep}), 1e300), Rejection);
  EXPECT_THROW(penalty_wrench(touched({deep, deep}), 1e300), Rejection);
}
