#include "geometry/distance/triangle_crossing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/core_distance_oracle.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kTriangleCore = 1;  // of make_core()

/// A triangle of about this size that has the origin near it [m].
Triangle random_triangle(double size, Random& random) {
  const Vector3d middle = random.point(0.5 * size);
  return {middle + random.point(size), middle + random.point(size), middle + random.point(size)};
}

/// How many pairs of a kind were decided.
struct Decisions {
  int crossing = 0, apart = 0, open = 0;
};

/// Compares the decision about two triangles, if there is one, with the exact distance.
void expect_true(const Triangle& core, const Triangle& face, double bound, Decisions& decisions) {
  const double size = std::max(largest_coordinate(core), largest_coordinate(face));
  const double distance = oracle::distance(ConvexCore(core), face);
  const auto decided = triangle_crossing(core, face, bound);
  if (!decided) {
    ++decisions.open;
    return;
  }
  if (decided->distance > bound) {
    ++decisions.apart;
    EXPECT_LE(decided->distance, distance + 1e-14 * size) << "must be a lower bound";
    return;
  }
  ++decisions.crossing;
  EXPECT_LE(decided->distance, tolerance::kTie);
  EXPECT_LE(distance, tolerance::kTie + 1e-15 * size);
  EXPECT_GE(decided->barycentric.minCoeff(), 0.0);
  EXPECT_NEAR(decided->barycentric.sum(), 1.0, 1e-15);
  EXPECT_EQ(decided->on_face, point_at(face, decided->barycentric));
  EXPECT_EQ(decided->separation, decided->on_face - decided->on_core);
  EXPECT_EQ(decided->separation.norm(), decided->distance);
  EXPECT_LE(oracle::distance(ConvexCore(core), decided->on_core), 1e-14 * (1.0 + size));
}

// The core is pierced by an edge of the face, from (0.2, 0.2, 0) on. The common segment ends where
// the core does.
TEST(TriangleCrossing, IsInTheMiddleOfTheCommonSegment) {
  const Triangle core = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const Triangle face = {Vector3d(0.2, 0.2, -1), Vector3d(0.2, 0.2, 1), Vector3d(2.2, 0.2, 0)};
  const auto crossing = triangle_crossing(core, face, kInfinity);
  ASSERT_TRUE(crossing);
  EXPECT_LE(crossing->distance, 1e-15);
  EXPECT_TRUE(crossing->on_face.isApprox(Vector3d(0.5, 0.2, 0.0), 1e-15));
  EXPECT_TRUE(crossing->barycentric.isApprox(Vector3d(0.425, 0.425, 0.15), 1e-15));
}

// Each triangle meets the other one's plane, but only beside the other one. The gap is between an
// edge of the core at x = 0.1 and one of the face at x = 0.2.
TEST(TriangleCrossing, TrianglesBesideEachOtherAreApart) {
  const Triangle core = {Vector3d(0, 0, 0), Vector3d(0.1, -0.1, 0), Vector3d(0.1, 0.2, 0)};
  const Triangle face = {Vector3d(0.2, 0.01, -1), Vector3d(0.2, 0.01, 1), Vector3d(1.2, 0.01, 0)};
  const auto apart = triangle_crossing(core, face, 0.05);
  ASSERT_TRUE(apart);
  EXPECT_NEAR(apart->distance, 0.1, 1e-16);
  EXPECT_FALSE(triangle_crossing(core, face, 0.11)) << "nearer than the bound: not decided";
}

TEST(TriangleCrossing, IsOpenForTrianglesInOnePlaneOrOnOneSide) {
  const Triangle core = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const Triangle above = {Vector3d(0, 0, 1e-3), Vector3d(1, 0, 1e-3), Vector3d(0, 1, 2.0)};
  const Triangle point = {Vector3d(0.2, 0.2, 0), Vector3d(0.2, 0.2, 0), Vector3d(0.2, 0.2, 0)};
  for (const Triangle& face : {core, above, point}) {
    EXPECT_FALSE(triangle_crossing(core, face, 0.0));
    EXPECT_FALSE(triangle_crossing(face, core, 0.0));
  }
}

TEST(TriangleCrossing, IsTrueForTrianglesOfAllSizes) {
  Random random(1);
  Decisions decisions;
  for (int i = 0; i < 4000 && !HasFailure(); ++i) {
    const double bound = random.chance(0.5) ? tolerance::kConvexMargin : random.scale(1e-6, 1e-2);
    expect_true(random_triangle(random.scale(1e-3, 0.1), random),
                random_triangle(random.scale(1e-3, 0.1), random), bound, decisions);
  }
  EXPECT_GT(decisions.crossing, 200);
  EXPECT_GT(decisions.apart, 200);
}

// Corners and edges on the other triangle, common corners and edges, slivers.
TEST(TriangleCrossing, IsTrueForTrianglesThatBarelyTouch) {
  Random random(2);
  Decisions decisions;
  for (int i = 0; i < 4000 && !HasFailure(); ++i) {
    const Triangle core = random_triangle(0.05, random);
    Triangle face = random_triangle(random.scale(1e-3, 0.1), random);
    const double place = random.integer(0, 2) * 0.5;
    face[0] = core[0] + place * (core[1] - core[0]);
    if (random.chance(0.3)) face[1] = core[1] + random.uniform(0.0, 1.0) * (core[2] - core[1]);
    if (random.chance(0.3)) face[2] = face[0] + random.uniform(-1.0, 2.0) * (face[1] - face[0]);
    for (Vector3d& corner : face) {
      if (random.chance(0.5)) corner += random.scale(1e-17, 1e-6) * random.direction();
    }
    expect_true(core, face, tolerance::kConvexMargin, decisions);
    expect_true(face, core, tolerance::kConvexMargin, decisions);
  }
  EXPECT_GT(decisions.crossing, 200);
}

/// For each kind of trials.
class LinkTrials : public testing::TestWithParam<std::size_t> {};

TEST_P(LinkTrials, AreDecidedAsTheOracleSays) {
  Random random(700 + GetParam());
  Decisions decisions;
  for (int i = 0; i < 300 && !HasFailure(); ++i) {
    const LinkTrial trial = oracle::make_link_trial(GetParam(), kTriangleCore, random);
    const Triangle core = (trial.start * trial.core).triangle();
    expect_true(core, trial.face, trial.radius, decisions);
    if (HasFailure()) ADD_FAILURE() << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, LinkTrials,
                         testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()));

}  // namespace
}  // namespace organ_collision
