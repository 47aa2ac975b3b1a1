// contact_refiner.hpp for parts of links.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <tuple>

#include "organ_collision/geometry/tolerances.hpp"
#include "query/contact_refiner.hpp"
#include "test/proof/core_distance_oracle.hpp"
#include "test/proof/link_trials.hpp"

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
