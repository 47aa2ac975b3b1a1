// moving_part.hpp: the contact of one part of a tool and one face.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <tuple>

#include "scenes.hpp"
#include "test/proof/exact_distance.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

constexpr std::int32_t kNumber = 3;  ///< of the link

/// A face on one leg of a step, and where it is at the end of the whole step.
struct FaceLeg {
  FaceMotion motion;
  double begin, finish;  ///< fractions of the step at which the leg begins and ends
  Triangle end;          ///< the face at the end of the step
};

/// The contact of a part and a face.
std::optional<FaceContact> refine(const MovingPart& part, const FaceLeg& face) {
  const auto touch = first_touch(part.core(), face.motion, part.radius());
  if (!touch) return std::nullopt;
  FaceContact contact = part.contact(*touch, face.motion, face.end);
  contact.fraction = face.begin + touch->time * (face.finish - face.begin);
  return contact;
}

Triangle shifted_by(Triangle face, const Vector3d& shift) {
  for (Vector3d& corner : face) corner += shift;
  return face;
}

/// Twice the area, along the normal; zero if the face is nearly degenerate.
Vector3d area_of(const Triangle& face) {
  const Vector3d a = face[1] - face[0], b = face[2] - face[0];
  const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  const Vector3d area = a.cross(b);
  return area.norm() > 1e-8 * longest ? area : Vector3d(Vector3d::Zero());
}

/// What moves on the leg. kAll: the face, too, and tool and face have moved on at the step's end.
enum class Moves { kNothing, kTool, kAll };

/// A shaft, or a part of a link, and a face.
struct PartTrial {
  /// Numbers count the kinds of trials with a shaft, then those with each kind of core.
  PartTrial(std::size_t number, Moves moves, Random& random) {
    const bool on = moves == Moves::kAll;
    const std::size_t shafts = oracle::trial_kinds().size();
    const Vector3d shift = on ? Vector3d(0.02 * random.direction()) : Vector3d(Vector3d::Zero());
    Triangle at_leg_end;
    if (number < shafts) {
      const oracle::Trial trial = oracle::make_trial(number, random);
      const ShaftMotion& leg = trial.motion;
      end_axis = {leg.end.trocar, leg.end.tip + shift};
      part = std::make_unique<MovingShaft>(
          ShaftMotion{moves == Moves::kNothing ? leg.end : leg.start, leg.end}, trial.radius,
          end_axis);
      at_leg_end = trial.face;
      text << oracle::to_line(trial);
    } else {
      const std::size_t kind = (number - shafts) / oracle::kCoreKinds;
      const oracle::LinkTrial trial =
          oracle::make_link_trial(kind, (number - shafts) % oracle::kCoreKinds, random);
      link.parts.resize(1);  // Its box is not used.
      link.parts[0].core = trial.core;
      link.parts[0].radius = trial.radius;
      motion.emplace(moves == Moves::kNothing ? trial.end : trial.start, trial.end);
      end_pose = trial.end;
      if (on) end_pose.linear() *= oracle::random_turn(random.uniform(0.0, 1.0), random);
      end_pose.pretranslate(shift);
      part = std::make_unique<MovingLinkPart>(link.parts[0], link, kNumber, *motion, end_pose);
      at_leg_end = trial.face;
      text << trial;
    }
    const Vector3d back = on ? Vector3d(0.01 * random.direction()) : Vector3d(Vector3d::Zero());
    face = {{shifted_by(at_leg_end, back), at_leg_end},
            on ? 0.25 : 0.0,
            on ? 0.75 : 1.0,
            shifted_by(at_leg_end, -0.5 * shift)};
    double largest = 0.2;
    for (const Vector3d& corner : at_leg_end) largest += corner.norm();
    rounding = 1e-15 * largest;
    slack = is_shaft() ? 1e-12 + rounding : 2e-9 + 100.0 * rounding;
  }
  PartTrial(const PartTrial&) = delete;
  PartTrial& operator=(const PartTrial&) = delete;

  bool is_shaft() const { return !motion; }
  std::optional<FaceContact> contact() const { return refine(*part, face); }
  double time(const FaceContact& contact) const {
    return (contact.fraction - face.begin) / (face.finish - face.begin);
  }
  ConvexCore end_core() const {
    return is_shaft() ? ConvexCore(end_axis) : end_pose * link.parts[0].core;
  }
  /// Where the point of the core that touched is at the end of the step.
  Vector3d touching_point_at_end(const FaceContact& contact, double distance) const {
    if (is_shaft()) return end_axis.at(contact.shaft);
    const Vector3d at_touch = contact.point - distance * contact.normal;
    return end_pose * (motion->at(time(contact)).inverse() * at_touch);
  }

  Link link;
  std::optional<RigidMotion> motion;  ///< of the link
  std::unique_ptr<MovingPart> part;
  ShaftAxis end_axis = kNoShaft;                 ///< at the end of the step
  Isometry3d end_pose = Isometry3d::Identity();  ///< of the link, at the end of the step
  FaceLeg face;
  double rounding = 0.0;  ///< [m] of the coordinates
  double slack = 0.0;     ///< [m] the error of exact distances
  std::ostringstream text;
};

class ContactTrials : public testing::TestWithParam<std::size_t> {
 protected:
  template <typename Check>
  void for_each_trial(Moves moves, int count, Check check) {
    Random random(500 + GetParam());
    for (int i = 0; i < count && !HasFailure(); ++i) {
      const PartTrial trial(GetParam(), moves, random);
      check(trial);
      if (HasFailure()) ADD_FAILURE() << trial.text.str();
    }
  }
};

TEST_P(ContactTrials, AtRestMovingTheToolByDepthParts) {
  int contacts = 0;
  for_each_trial(Moves::kNothing, 150, [&](const PartTrial& trial) {
    const ConvexCore core = trial.part->core().end();
    const Triangle& face = trial.face.end;
    const double radius = trial.part->radius(), distance = oracle::distance(core, face);
    const auto contact = trial.contact();
    if (std::abs(distance - radius) > trial.slack) {
      EXPECT_EQ(contact.has_value(), distance < radius);
    }
    if (!contact) return;
    ++contacts;
    const Vector3d& normal = contact->normal;
    EXPECT_EQ(contact->fraction, 0.0);
    EXPECT_EQ(contact->link, trial.part->link());
    EXPECT_NEAR(normal.norm(), 1.0, 1e-14);
    Isometry3d parted = Isometry3d::Identity();
    parted.translation() = -contact->depth * normal;
    EXPECT_GE(oracle::distance(parted * core, face), radius - trial.slack);
    if (distance > 2.0 * tolerance::kPierced) {
      EXPECT_NEAR(contact->depth, radius - distance, trial.slack);
      return;
    }
    if (distance > 0.0) return;
    // The face is pierced: the normal is the face's own.
    const Vector3d area = area_of(face);
    if (!area.isZero(0.0)) {
      EXPECT_NEAR(std::abs(normal.dot(area.normalized())), 1.0, 1e-12);
    }
    const double place = normal.dot(contact->point);
    if (trial.is_shaft()) {
      const ShaftAxis axis = core.axis();
      EXPECT_GE(normal.dot(axis.tip - axis.trocar), -1e-12 * (axis.tip - axis.trocar).norm());
      EXPECT_NEAR(contact->depth, radius + normal.dot(axis.tip) - place, trial.slack);
      EXPECT_FALSE(contact->behind);
    } else {
      EXPECT_NEAR(contact->depth, core.support_value(normal) + radius - place, trial.slack);
      if (area.isZero(0.0)) return;
      const double other_way = core.support_value(-normal) + radius + place;
      EXPECT_LE(contact->depth, other_way + trial.slack);
    }
  });
  EXPECT_GT(contacts, 0);
}

TEST_P(ContactTrials, OnALegTheyAreAtTheRadiusAndTellOfTheEndOfTheStep) {
  int contacts = 0;
  const auto check = [&](const PartTrial& trial) {
    const auto contact = trial.contact();
    if (!contact) return;
    ++contacts;
    const double time = trial.time(*contact), radius = trial.part->radius();
    const Triangle face = trial.face.motion.at(time);
    const double distance = oracle::distance(trial.part->core().at(time), face);
    if (time > 0.0) {
      EXPECT_NEAR(distance, radius, trial.is_shaft() ? 1e-9 : 1e-8);
    }
    EXPECT_LE((contact->point - point_at(face, contact->barycentric)).norm(), trial.slack);
    EXPECT_NEAR(contact->barycentric.sum(), 1.0, 1e-14);
    const Vector3d& on_organ = contact->on_organ;
    EXPECT_LE((on_organ - point_at(trial.face.end, contact->barycentric)).norm(), trial.slack);
    const Vector3d& normal = contact->normal;
    if (distance < 0.5 * tolerance::kPierced) {
      const double reach = trial.is_shaft() ? normal.dot(trial.end_axis.tip)
                                            : trial.end_core().support_value(normal);
      EXPECT_NEAR(contact->depth, reach + radius - normal.dot(on_organ), trial.slack);
    } else if (trial.is_shaft() ? distance > 2.0 * tolerance::kPierced : distance > 1e-5) {
      const Vector3d core_end = trial.touching_point_at_end(*contact, distance);
      const double depth = radius - normal.dot(on_organ - core_end);
      EXPECT_NEAR(contact->depth, depth, trial.is_shaft() ? trial.slack : 1e-8);
      const Vector3d area = area_of(trial.face.end);
      const double side = area.isZero(0.0) ? 0.0 : area.normalized().dot(core_end - on_organ);
      if (std::abs(side) > 1e-6) {
        EXPECT_EQ(contact->behind, side < 0.0);
      }
    }
  };
  for_each_trial(Moves::kTool, 150, check);
  for_each_trial(Moves::kAll, 150, check);
  EXPECT_GT(contacts, 0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ContactTrials,
                         testing::Range<std::size_t>(0, oracle::trial_kinds().size() +
                                                            oracle::kCoreKinds *
                                                                oracle::link_trial_kinds().size()));

// What rounding must not decide.

constexpr double kShaftRadius = 5e-3;
const Isometry3d kOrigin = Isometry3d::Identity();
const LinkPart kCube = LinkPart::box(kOrigin, {0.1, 0.1, 0.1});

/// A face in a plane at right angles to z, whose outer side is up.
Triangle face_at(double z) {
  return {Vector3d(-0.02, -0.03, z), Vector3d(0.05, -0.03, z), Vector3d(-0.02, 0.06, z)};
}

FaceContact at_rest(const ShaftAxis& axis, const Triangle& face) {
  const auto contact =
      refine(MovingShaft({axis, axis}, kShaftRadius, axis), {{face, face}, 0, 1, face});
  EXPECT_TRUE(contact);
  return contact.value_or(FaceContact());
}

FaceContact at_rest(const Link& link, const Triangle& face) {
  const RigidMotion motion(kOrigin, kOrigin);
  const LinkPart& part = link.parts[0];
  const auto contact =
      refine(MovingLinkPart(part, link, kNumber, motion, kOrigin), {{face, face}, 0, 1, face});
  EXPECT_TRUE(contact);
  return contact.value_or(FaceContact());
}

// The ends of the axis are tied, but only one of them is within the radius.
TEST(Contact, OfATieIsDecidedByTheLeastDistance) {
  const Triangle face = {Vector3d(-1.0, -1.0, 0.0), Vector3d(1.0, -1.0, 0.0),
                         Vector3d(1.0, 1.0, 0.0)};
  const Vector3d low(0.0, 0.0, 0.005), high(0.1, 0.0, 0.005 + 9e-13);
  for (const ShaftAxis& axis : {ShaftAxis{low, high}, ShaftAxis{high, low}}) {
    const auto contact =
        refine(MovingShaft({axis, axis}, 0.005 + 2.25e-13, axis), {{face, face}, 0, 1, face});
    ASSERT_TRUE(contact);
    EXPECT_EQ(contact->shaft, 1.0);
    EXPECT_GE(contact->depth, 0.0);
    EXPECT_LT(contact->depth, 1e-12);
  }
}

// An axis in the face's plane, and a link that can leave the face upward or downward by the same
// distance. The sign of the normal's first nonzero component decides, and not the order of the
// corners.
TEST(Contact, PiercedEitherWayTakesTheNormalWithAPositiveFirstComponent) {
  const ShaftAxis axis{{-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}};
  const Triangle face = face_at(0.0);
  for (const Triangle& same : {face, Triangle{face[0], face[2], face[1]}}) {
    const FaceContact of_shaft = at_rest(axis, same), of_link = at_rest(Link{"jaw", {kCube}}, same);
    EXPECT_TRUE(of_shaft.normal.isApprox(Vector3d(0.0, 0.0, 1.0), 1e-14));
    EXPECT_NEAR(of_shaft.depth, kShaftRadius, 1e-14);
    EXPECT_TRUE(of_link.normal.isApprox(Vector3d(0.0, 0.0, 1.0), 1e-14));
    EXPECT_NEAR(of_link.depth, 0.05 + tolerance::kConvexMargin, 1e-12);
  }
}

TEST(Contact, OfDegenerateFacesIsAtRightAnglesToAxisAndLongestEdge) {
  const ShaftAxis axis{{0.1, 0.2, 0.5}, {0.1, 0.2, 0.0}};
  const Vector3d a(0.0, 0.2, 0.1), b(0.3, 0.2, 0.1), c(0.15, 0.2, 0.1), p(0.1, 0.2, 0.3);
  for (const Triangle& face : {Triangle{a, b, b}, Triangle{b, c, a}, Triangle{c, b, a}}) {
    const FaceContact contact = at_rest(axis, face);
    EXPECT_TRUE(contact.normal.isApprox(Vector3d(0.0, 1.0, 0.0), 1e-12));
    EXPECT_NEAR(contact.depth, kShaftRadius, 1e-14);
    EXPECT_FALSE(contact.behind);
  }
  EXPECT_NEAR(at_rest(axis, {p, p, p}).normal.norm(), 1.0, 1e-14);
  EXPECT_NEAR(at_rest(axis, {p, p, p}).normal.z(), 0.0, 1e-14);
}

TEST(Contact, OfDegenerateFacesInsideALinkHasADirection) {
  const Vector3d a(0.01, 0.0, 0.0), b(0.02, 0.01, 0.0), c(0.03, 0.02, 0.0);
  for (const Triangle& face : {Triangle{a, b, b}, Triangle{a, b, c}, Triangle{a, a, a}}) {
    const FaceContact contact = at_rest(Link{"jaw", {kCube}}, face);
    EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-14);
    EXPECT_NEAR(contact.normal.dot(face[1] - face[0]), 0.0, 1e-15);
    EXPECT_GT(contact.depth, 0.0);
    EXPECT_FALSE(contact.behind);
  }
}

// Because of the rod on the cube, the link would have to move farther downward than upward.
TEST(Contact, PiercedLeavesWithTheWholeLink) {
  Isometry3d above = kOrigin;
  above.translation().z() = 0.2;
  const FaceContact contact =
      at_rest(Link{"jaw", {kCube, LinkPart::cylinder(above, 0.01, 0.4)}}, face_at(0.03));
  EXPECT_TRUE(contact.normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-14));
  EXPECT_NEAR(contact.depth, 0.08 + tolerance::kConvexMargin, 1e-12);
}

}  // namespace
}  // namespace organ_collision
