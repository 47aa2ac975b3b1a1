#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <tuple>

#include "organ_collision/geometry/tolerances.hpp"
#include "query/contact_refiner.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;
using oracle::Trial;

struct LegAndEnd {
  ShaftMotion shaft;
  FaceMotion face;
  double begin, finish;
  ShaftAxis shaft_end;
  Triangle face_end;
};

std::optional<FaceContact> refine(const LegAndEnd& step, double radius) {
  return refine(PartLeg{step.shaft, radius, {step.shaft_end}},
                FaceLeg{step.face, step.begin, step.finish, step.face_end});
}

LegAndEnd at_rest(const ShaftAxis& axis, const Triangle& face) {
  return {{axis, axis}, {face, face}, 0.0, 1.0, axis, face};
}

LegAndEnd whole_step(const ShaftMotion& motion, const FaceMotion& face) {
  return {motion, face, 0.0, 1.0, motion.end, face.end};
}

LegAndEnd whole_step(const ShaftMotion& motion, const Triangle& face) {
  return whole_step(motion, FaceMotion{face, face});
}

Vector3d on(const Triangle& face, const Vector3d& barycentric) {
  return barycentric[0] * face[0] + barycentric[1] * face[1] + barycentric[2] * face[2];
}

Vector3d outward(const Triangle& face) {
  return (face[1] - face[0]).cross(face[2] - face[0]).normalized();
}

ShaftAxis moved(const ShaftAxis& axis, const Vector3d& by) {
  return {axis.trocar + by, axis.tip + by};
}

/// [m] A bound on the rounding errors of the trial's coordinates.
double rounding(const Trial& trial) {
  double largest = trial.motion.end.tip.norm() + trial.motion.end.trocar.norm();
  for (const Vector3d& corner : trial.face) largest += corner.norm();
  return 1e-15 * largest;
}

class ContactTrials : public testing::TestWithParam<std::size_t> {
 protected:
  template <typename Check>
  void for_each_trial(int count, Check check) {
    Random random(500 + GetParam());
    for (int i = 0; i < count && !HasFailure(); ++i) {
      const Trial trial = oracle::make_trial(GetParam(), random);
      check(trial);
      if (HasFailure()) ADD_FAILURE() << oracle::to_line(trial);
    }
  }
};

TEST_P(ContactTrials, AtRestMovingTheToolByDepthParts) {
  int contacts = 0;
  for_each_trial(300, [&](const Trial& trial) {
    const ShaftAxis& axis = trial.motion.end;
    const auto contact = refine(at_rest(axis, trial.face), trial.radius);
    const double distance = oracle::distance(oracle::core(axis), trial.face);
    if (distance < trial.radius - 1e-12) {
      EXPECT_TRUE(contact);
    }
    if (distance > trial.radius + 1e-12) {
      EXPECT_FALSE(contact);
    }
    if (!contact) return;
    ++contacts;
    EXPECT_EQ(contact->fraction, 0.0);
    EXPECT_NEAR(contact->normal.norm(), 1.0, 1e-14);
    const double slack = rounding(trial);
    const ShaftAxis parted = moved(axis, -contact->depth * contact->normal);
    const double after = oracle::distance(oracle::core(parted), trial.face);
    EXPECT_GE(after, trial.radius - 1e-12 - slack);
    if (distance > 2 * tolerance::kPierced) {
      EXPECT_NEAR(after, trial.radius, 1e-12 + slack);
      EXPECT_NEAR(contact->depth, trial.radius - distance, 1e-15 + slack);
      EXPECT_NEAR(contact->normal.dot(contact->point - axis.at(contact->shaft)), distance,
                  1e-15 + slack);
    }
  });
  EXPECT_GT(contacts, 0);
}

TEST_P(ContactTrials, PiercedAtRestTakesTheFaceNormalTheToolsWay) {
  for_each_trial(300, [](const Trial& trial) {
    const ShaftAxis& axis = trial.motion.end;
    const auto contact = refine(at_rest(axis, trial.face), trial.radius);
    if (oracle::distance(oracle::core(axis), trial.face) > 0.0) return;
    ASSERT_TRUE(contact);
    const Vector3d along = axis.tip - axis.trocar;
    EXPECT_GE(contact->normal.dot(along), -1e-12 * along.norm());
    EXPECT_FALSE(contact->behind);
    const double slack = 1e-15 + rounding(trial);
    EXPECT_NEAR(contact->depth, trial.radius + contact->normal.dot(axis.tip - contact->point),
                slack);
    const Vector3d area = (trial.face[1] - trial.face[0]).cross(trial.face[2] - trial.face[0]);
    if (area.norm() > 1e-9 * (trial.face[1] - trial.face[0]).squaredNorm()) {
      EXPECT_NEAR(std::abs(contact->normal.dot(area.normalized())), 1.0, 1e-12);
    } else {
      EXPECT_NEAR(contact->normal.dot(along), 0.0, 1e-9 * along.norm());
    }
  });
}

TEST_P(ContactTrials, SweptIsAtTheRadiusAndDepthIsOfTheEnd) {
  for_each_trial(300, [](const Trial& trial) {
    const auto contact = refine(whole_step(trial.motion, trial.face), trial.radius);
    if (!contact) return;
    const ShaftAxis at_touch = trial.motion.at(contact->fraction);
    const double distance = (contact->point - at_touch.at(contact->shaft)).norm();
    const double slack = 1e-14 + rounding(trial);
    if (oracle::distance(oracle::core(trial.motion.start), trial.face) > trial.radius) {
      EXPECT_NEAR(distance, trial.radius, 1e-9);
    } else {
      EXPECT_EQ(contact->fraction, 0.0);
    }
    EXPECT_NEAR(contact->barycentric.sum(), 1.0, 1e-15);
    EXPECT_LE((on(trial.face, contact->barycentric) - contact->point).norm(), slack);
    const ShaftAxis& end = trial.motion.end;
    const double depth =
        distance <= tolerance::kPierced
            ? trial.radius + contact->normal.dot(end.tip - contact->point)
            : trial.radius - contact->normal.dot(contact->point - end.at(contact->shaft));
    EXPECT_NEAR(contact->depth, depth, slack);
  });
}

TEST_P(ContactTrials, OrderOfCornersChangesNothing) {
  constexpr std::array<std::array<int, 3>, 5> kOrders = {
      {{1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};
  for_each_trial(200, [&](const Trial& trial) {
    const auto contact = refine(whole_step(trial.motion, trial.face), trial.radius);
    for (const auto& order : kOrders) {
      const Triangle face = {trial.face[order[0]], trial.face[order[1]], trial.face[order[2]]};
      const auto other = refine(whole_step(trial.motion, face), trial.radius);
      const double gap = oracle::distance(oracle::core(trial.motion), trial.face) - trial.radius;
      if (std::abs(gap) > 1e-9) {
        ASSERT_EQ(other.has_value(), contact.has_value());
      }
      if (!contact || !other || std::abs(gap) < 1e-6) continue;
      EXPECT_NEAR(other->fraction, contact->fraction, 1e-5);
      EXPECT_LE((other->normal - contact->normal).norm(), 1e-4);
      EXPECT_NEAR(other->depth, contact->depth, 1e-4);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, ContactTrials,
                         testing::Range<std::size_t>(0, oracle::trial_kinds().size()));

// A face in the plane z = 0.1, whose outer side is up.
const Triangle kFace = {Vector3d(-0.02, -0.03, 0.1), Vector3d(0.05, -0.03, 0.1),
                        Vector3d(-0.02, 0.06, 0.1)};
const Vector3d kTrocar(0.01, -0.01, 0.4);
constexpr double kRadius = 5e-3;

TEST(Contact, OfATipAboveTheFace) {
  const ShaftAxis axis{kTrocar, {0.0, 0.0, 0.103}};
  const auto contact = refine(at_rest(axis, kFace), kRadius);
  ASSERT_TRUE(contact);
  EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-12));
  EXPECT_TRUE(contact->point.isApprox(Vector3d(0.0, 0.0, 0.1), 1e-12));
  EXPECT_EQ(contact->shaft, 1.0);
  EXPECT_NEAR(contact->depth, 0.002, 1e-15);
  EXPECT_FALSE(contact->behind);
}

// The ends of the axis are tied, but only one of them is within the radius.
TEST(Contact, OfATieIsDecidedByTheLeastDistance) {
  const Triangle face = {Vector3d(-1.0, -1.0, 0.0), Vector3d(1.0, -1.0, 0.0),
                         Vector3d(1.0, 1.0, 0.0)};
  const Vector3d low(0.0, 0.0, 0.005), high(0.1, 0.0, 0.005 + 9e-13);
  for (const ShaftAxis& axis : {ShaftAxis{low, high}, ShaftAxis{high, low}}) {
    const auto contact = refine(at_rest(axis, face), 0.005 + 2.25e-13);
    ASSERT_TRUE(contact);
    EXPECT_EQ(contact->shaft, 1.0);
    EXPECT_GE(contact->depth, 0.0);
    EXPECT_LT(contact->depth, 1e-12);
  }
}

TEST(Contact, OfATipBelowTheFaceIsBehind) {
  const Vector3d below(0.0, 0.0, 0.0);
  const auto contact = refine(at_rest({below, {0.0, 0.0, 0.097}}, kFace), kRadius);
  ASSERT_TRUE(contact);
  EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 0.0, 1.0), 1e-12));
  EXPECT_TRUE(contact->behind);
}

TEST(Contact, PassedThroughIsDeeperThanTheRadiusAndBehind) {
  const ShaftMotion motion{{kTrocar, {0.0, 0.0, 0.15}}, {kTrocar, {0.0, 0.0, 0.04}}};
  const auto contact = refine(whole_step(motion, kFace), kRadius);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->fraction, 45.0 / 110.0, 1e-7);
  EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-7));
  EXPECT_NEAR(contact->depth, kRadius + 0.06, 1e-9);
  EXPECT_TRUE(contact->behind);
}

TEST(Contact, TouchedAndLeftHasANegativeDepth) {
  // The tip comes down onto the face in the first leg. At the end of the step it is withdrawn.
  const ShaftMotion down{{kTrocar, {0.0, 0.0, 0.15}}, {kTrocar, {0.0, 0.0, 0.1}}};
  const ShaftAxis withdrawn{kTrocar, {0.0, 0.0, 0.2}};
  const auto touched = refine({down, {kFace, kFace}, 0.0, 0.5, withdrawn, kFace}, kRadius);
  ASSERT_TRUE(touched);
  EXPECT_NEAR(touched->fraction, 0.45, 1e-7);
  EXPECT_NEAR(touched->depth, kRadius - 0.1, 1e-8);
  EXPECT_FALSE(touched->behind);

  // The tissue moves away from a resting tool.
  const Vector3d away(0.0, 0.0, -0.1);
  const FaceMotion leaves{kFace, {kFace[0] + away, kFace[1] + away, kFace[2] + away}};
  const ShaftAxis axis{kTrocar, {0.0, 0.0, 0.103}};
  const auto left = refine(whole_step({axis, axis}, leaves), kRadius);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->fraction, 0.0);
  EXPECT_NEAR(left->depth, 0.002 - 0.1, 1e-15);
}

TEST(Contact, PiercedAtTheStartKeepsTheFaceNormal) {
  const ShaftMotion motion{{kTrocar, {0.0, 0.0, 0.08}}, {kTrocar, {0.0, 0.0, 0.05}}};
  const auto contact = refine(whole_step(motion, kFace), kRadius);
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->fraction, 0.0);
  EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-14));
  EXPECT_NEAR(contact->depth, kRadius + 0.05, 1e-15);
  EXPECT_NEAR(contact->point.z(), 0.1, 1e-15);
}

TEST(Contact, PiercedFromInsideTurnsTheNormalTheToolsWay) {
  const auto contact = refine(at_rest({{0.0, 0.0, -0.2}, {0.0, 0.0, 0.13}}, kFace), kRadius);
  ASSERT_TRUE(contact);
  EXPECT_TRUE(contact->normal.isApprox(outward(kFace), 1e-14));
  EXPECT_NEAR(contact->depth, kRadius + 0.03, 1e-15);
}

TEST(Contact, AxisInTheFacesPlaneTakesTheNormalWithAPositiveFirstComponent) {
  const ShaftAxis axis{{-0.1, 0.0, 0.1}, {0.1, 0.0, 0.1}};
  for (const Triangle& face : {kFace, Triangle{kFace[0], kFace[2], kFace[1]}}) {
    const auto contact = refine(at_rest(axis, face), kRadius);
    ASSERT_TRUE(contact);
    EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 0.0, 1.0), 1e-14));
    EXPECT_NEAR(contact->depth, kRadius, 1e-14);
  }
}

TEST(Contact, OfDegenerateFacesIsAtRightAnglesToAxisAndLongestEdge) {
  const ShaftAxis axis{{0.1, 0.2, 0.5}, {0.1, 0.2, 0.0}};
  const Vector3d a(0.0, 0.2, 0.1), b(0.3, 0.2, 0.1), c(0.15, 0.2, 0.1), p(0.1, 0.2, 0.3);
  for (const Triangle& face : {Triangle{a, b, b}, Triangle{b, c, a}, Triangle{c, b, a}}) {
    const auto contact = refine(at_rest(axis, face), kRadius);
    ASSERT_TRUE(contact);
    EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 1.0, 0.0), 1e-12));
    EXPECT_NEAR(contact->depth, kRadius, 1e-14);
    EXPECT_FALSE(contact->behind);
  }
  const auto contact = refine(at_rest(axis, {p, p, p}), kRadius);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->normal.norm(), 1.0, 1e-14);
  EXPECT_NEAR(contact->normal.z(), 0.0, 1e-14);
  EXPECT_NEAR(contact->depth, kRadius, 1e-14);
}

TEST(Contact, OfABall) {
  const Vector3d center(0.0, 0.0, 0.102);
  const auto contact = refine(at_rest({center, center}, kFace), kRadius);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->depth, 0.003, 1e-15);
  EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-12));
  const Vector3d in_face(0.0, 0.0, 0.1);
  const auto pierced = refine(at_rest({in_face, in_face}, kFace), kRadius);
  ASSERT_TRUE(pierced);
  EXPECT_TRUE(pierced->normal.isApprox(Vector3d(0.0, 0.0, 1.0), 1e-12));
  EXPECT_NEAR(pierced->depth, kRadius, 1e-15);
}

TEST(Contact, FractionIsOfTheWholeStepAndDepthOfItsEnd) {
  const ShaftMotion leg{{kTrocar, {0.0, 0.0, 0.15}}, {kTrocar, {0.0, 0.0, 0.05}}};
  const ShaftAxis end{kTrocar, {0.0, 0.0, 0.102}};
  const LegAndEnd step{leg, {kFace, kFace}, 0.25, 0.5, end, kFace};
  const auto contact = refine(step, kRadius);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->fraction, 0.25 + 0.25 * 0.45, 1e-7);
  EXPECT_NEAR(contact->depth, 0.003, 1e-8);
  EXPECT_FALSE(contact->behind);
}

}  // namespace

}  // namespace organ_collision

// contact_refiner.hpp for parts of links.

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

constexpr std::uint32_t kNumber = 3;
/// [m] Allowed error of the distances between cores and faces.
constexpr double kSlack = 2e-9;

/// The step that a leg belongs to: the fractions at which the leg begins and ends, and link and
/// face at the end of the step.
struct Rest {
  double begin, finish;
  Isometry3d link_end;
  Triangle face_end;
};

/// The contact of a part of `link` on a leg from `start` to `end`.
std::optional<FaceContact> refine(const Link& link, const LinkPart& part, const Isometry3d& start,
                                  const Isometry3d& end, const FaceMotion& face, const Rest& rest) {
  const RigidMotion motion(start, end);
  return refine(PartLeg{{part.core, motion}, part.radius, {{}, &link, rest.link_end}, kNumber},
                FaceLeg{face, rest.begin, rest.finish, rest.face_end});
}

/// The contact of a link that has only this part, during a whole step.
std::optional<FaceContact> refine(const LinkPart& part, const Isometry3d& start,
                                  const Isometry3d& end, const Triangle& face) {
  const Link link{"jaw", {part}};
  return refine(link, part, start, end, {face, face}, {0.0, 1.0, end, face});
}

LinkPart part_of(const LinkTrial& trial) { return {trial.core, nullptr, trial.radius, {}}; }

Vector3d on(const Triangle& face, const Vector3d& barycentric) {
  return barycentric[0] * face[0] + barycentric[1] * face[1] + barycentric[2] * face[2];
}

bool is_degenerate(const Triangle& face) {
  const Vector3d a = face[1] - face[0], b = face[2] - face[0];
  return a.cross(b).norm() <= 1e-9 * std::max(a.squaredNorm(), b.squaredNorm());
}

class LinkContactTrials : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {
 protected:
  template <typename Check>
  void for_each_trial(int count, Check check) {
    const auto [kind, core_kind] = GetParam();
    Random random(800 + 10 * kind + core_kind);
    for (int i = 0; i < count && !HasFailure(); ++i) {
      const LinkTrial trial = oracle::make_link_trial(kind, core_kind, random);
      check(trial);
      if (HasFailure()) ADD_FAILURE() << trial;
    }
  }
};

TEST_P(LinkContactTrials, AtRestMovingTheLinkByDepthParts) {
  int contacts = 0;
  for_each_trial(150, [&](const LinkTrial& trial) {
    const auto contact = refine(part_of(trial), trial.end, trial.end, trial.face);
    const double distance = oracle::distance(trial.end * trial.core, trial.face);
    if (distance < trial.radius - kSlack) {
      EXPECT_TRUE(contact);
    }
    if (distance > trial.radius + kSlack) {
      EXPECT_FALSE(contact);
    }
    if (!contact) return;
    ++contacts;
    EXPECT_EQ(contact->fraction, 0.0);
    EXPECT_EQ(contact->link, kNumber);
    EXPECT_EQ(contact->shaft, 0.0);
    EXPECT_NEAR(contact->normal.norm(), 1.0, 1e-14);
    EXPECT_LE((contact->point - on(trial.face, contact->barycentric)).norm(),
              1e-10 + 20.0 * oracle::rounding(trial));
    Isometry3d parted = trial.end;
    parted.pretranslate(-contact->depth * contact->normal);
    const double after = oracle::distance(parted * trial.core, trial.face);
    EXPECT_GE(after, trial.radius - kSlack - 20.0 * oracle::rounding(trial));
    if (distance > 2.0 * tolerance::kPierced) {
      EXPECT_NEAR(contact->depth, trial.radius - distance, kSlack);
    }
  });
  EXPECT_GT(contacts, 0);
}

TEST_P(LinkContactTrials, PiercedAtRestTakesTheFaceNormalOfTheShorterWayOut) {
  for_each_trial(150, [](const LinkTrial& trial) {
    const ConvexCore core = trial.end * trial.core;
    if (oracle::distance(core, trial.face) > 0.0) return;
    const auto contact = refine(part_of(trial), trial.end, trial.end, trial.face);
    ASSERT_TRUE(contact);
    const double slack = 1e-9 + 100.0 * oracle::rounding(trial);
    const Vector3d& normal = contact->normal;
    const double out = core.support_value(normal) + trial.radius - normal.dot(contact->point);
    EXPECT_NEAR(contact->depth, out, slack);
    if (is_degenerate(trial.face)) return;
    const Vector3d area = (trial.face[1] - trial.face[0]).cross(trial.face[2] - trial.face[0]);
    EXPECT_NEAR(std::abs(normal.dot(area.normalized())), 1.0, 1e-12);
    const double other_way =
        core.support_value(-normal) + trial.radius + normal.dot(contact->point);
    EXPECT_LE(contact->depth, other_way + slack);
  });
}

TEST_P(LinkContactTrials, SweptDepthIsThatOfTheEnd) {
  int contacts = 0;
  for_each_trial(150, [&](const LinkTrial& trial) {
    const LinkPart part = part_of(trial);
    const auto contact = refine(part, trial.start, trial.end, trial.face);
    if (!contact) return;
    ++contacts;
    const Isometry3d at_touch = trial.motion().at(contact->fraction);
    const double distance = oracle::distance(at_touch * trial.core, trial.face);
    if (contact->fraction > 0.0) {
      EXPECT_NEAR(distance, trial.radius, 1e-8);
    }
    const Vector3d& normal = contact->normal;
    if (distance < 0.5 * tolerance::kPierced) {
      EXPECT_NEAR(contact->depth,
                  (trial.end * trial.core).support_value(normal) + trial.radius -
                      normal.dot(contact->point),
                  1e-9 + 100.0 * oracle::rounding(trial));
    } else if (distance > 1e-5) {
      // The point of the core that touched, moved with the link.
      const Vector3d core_at_touch = contact->point - distance * normal;
      const Vector3d core_end = trial.end * (at_touch.inverse() * core_at_touch);
      EXPECT_NEAR(contact->depth, trial.radius - normal.dot(contact->point - core_end), 1e-8);
    }
  });
  EXPECT_GT(contacts, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, LinkContactTrials,
    testing::Combine(testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()),
                     testing::Range<std::size_t>(0, oracle::kCoreKinds)));

/// A face in the plane z, whose outer side is up.
Triangle face_at(double z) {
  return {Vector3d(-0.02, -0.03, z), Vector3d(0.05, -0.03, z), Vector3d(-0.02, 0.06, z)};
}

Isometry3d at(const Vector3d& translation) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = translation;
  return pose;
}

const Isometry3d kOrigin = Isometry3d::Identity();
const LinkPart kCube = LinkPart::box(kOrigin, {0.1, 0.1, 0.1});

TEST(LinkContact, OfABallAboveTheFace) {
  const LinkPart ball = LinkPart::sphere({0.0, 0.0, 0.008}, 0.01);
  const auto contact = refine(ball, at({0.0, 0.0, 0.1}), at({0.0, 0.0, 0.1}), face_at(0.1));
  ASSERT_TRUE(contact);
  EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-12));
  EXPECT_TRUE(contact->point.isApprox(Vector3d(0.0, 0.0, 0.1), 1e-12));
  EXPECT_NEAR(contact->depth, 0.002, 1e-15);
  EXPECT_FALSE(contact->behind);
}

TEST(LinkContact, PiercedLeavesTheWayThatIsShorter) {
  const auto below = refine(kCube, kOrigin, kOrigin, face_at(0.03));
  ASSERT_TRUE(below);
  EXPECT_TRUE(below->normal.isApprox(Vector3d(0.0, 0.0, 1.0), 1e-14));
  EXPECT_NEAR(below->depth, 0.02 + tolerance::kConvexMargin, 1e-12);
  const auto above = refine(kCube, kOrigin, kOrigin, face_at(-0.01));
  ASSERT_TRUE(above);
  EXPECT_TRUE(above->normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-14));
  EXPECT_NEAR(above->depth, 0.04 + tolerance::kConvexMargin, 1e-12);
}

// The link can leave the face upward or downward by the same distance. The sign of the normal's
// first nonzero component decides, and not the order of the corners.
TEST(LinkContact, PiercedInTheMiddleTakesTheNormalWithAPositiveFirstComponent) {
  const Triangle face = face_at(0.0);
  for (const Triangle& same : {face, Triangle{face[0], face[2], face[1]}}) {
    const auto contact = refine(kCube, kOrigin, kOrigin, same);
    ASSERT_TRUE(contact);
    EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 0.0, 1.0), 1e-14));
    EXPECT_NEAR(contact->depth, 0.05 + tolerance::kConvexMargin, 1e-12);
  }
}

TEST(LinkContact, PiercedLeavesWithTheWholeLink) {
  // Because of the rod on the cube, the link would have to move farther downward than upward.
  const Link link{"jaw", {kCube, LinkPart::cylinder(at({0.0, 0.0, 0.2}), 0.01, 0.4)}};
  const Triangle face = face_at(0.03);
  const auto contact =
      refine(link, kCube, kOrigin, kOrigin, {face, face}, {0.0, 1.0, kOrigin, face});
  ASSERT_TRUE(contact);
  EXPECT_TRUE(contact->normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-14));
  EXPECT_NEAR(contact->depth, 0.08 + tolerance::kConvexMargin, 1e-12);
}

TEST(LinkContact, OfDegenerateFacesInsideHasADirection) {
  const Vector3d a(0.01, 0.0, 0.0), b(0.02, 0.01, 0.0), c(0.03, 0.02, 0.0);
  for (const Triangle& face : {Triangle{a, b, b}, Triangle{a, b, c}, Triangle{a, a, a}}) {
    const auto contact = refine(kCube, kOrigin, kOrigin, face);
    ASSERT_TRUE(contact);
    EXPECT_NEAR(contact->normal.norm(), 1.0, 1e-14);
    EXPECT_NEAR(contact->normal.dot(face[1] - face[0]), 0.0, 1e-15);
    EXPECT_GT(contact->depth, 0.0);
    EXPECT_FALSE(contact->behind);
  }
}

TEST(LinkContact, FractionIsOfTheWholeStepAndDepthOfItsEnd) {
  const Link link{"jaw", {kCube}};
  const Triangle face = face_at(0.0);
  const FaceMotion rests{face, face};
  // On this leg the cube moves down through the face. At the end of the step it is above it again.
  const auto left = refine(link, kCube, at({0.0, 0.0, 0.15}), at({0.0, 0.0, 0.0}), rests,
                           {0.25, 0.75, at({0.0, 0.0, 0.07}), face});
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->fraction, 0.25 + 0.5 * 0.1 / 0.15, 1e-6);
  EXPECT_TRUE(left->normal.isApprox(Vector3d(0.0, 0.0, -1.0), 1e-6));
  EXPECT_NEAR(left->depth, -0.02, 1e-7);
  EXPECT_FALSE(left->behind);
  // At the end of the step the face has moved up through the cube.
  const auto passed = refine(link, kCube, at({0.0, 0.0, 0.15}), at({0.0, 0.0, 0.0}), rests,
                             {0.0, 0.5, at({0.0, 0.0, 0.07}), face_at(0.05)});
  ASSERT_TRUE(passed);
  EXPECT_NEAR(passed->depth, 0.03, 1e-7);
  EXPECT_TRUE(passed->behind);
}

// The corner that touched rotates with the link.
TEST(LinkContact, DepthIsOfThePointThatRotatedWithTheLink) {
  Isometry3d end = kOrigin;
  end.linear() = Eigen::AngleAxisd(0.8, Vector3d::UnitY()).toRotationMatrix();
  const LinkPart plate = LinkPart::box(kOrigin, {0.04, 0.04, 1e-6});
  const Triangle face = {Vector3d(-1.0, -1.0, -0.01), Vector3d(2.0, -1.0, -0.01),
                         Vector3d(-1.0, 2.0, -0.01)};
  const auto contact = refine(plate, kOrigin, end, face);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->depth, 0.02 * std::sin(0.8) - 0.01, 2e-6);
  EXPECT_TRUE(contact->behind);
}

}  // namespace

}  // namespace organ_collision
