// The distances themselves are compared with exact arithmetic to 1e-9 m by the proof of the
// clearance. These tests are stricter, and about what depends on the distances.
#include "geometry/distance/closest_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/trial_suites.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;
using oracle::Trial;

// The simplices of this sliver lose their last digits. The iteration once ended 5e-9 m too far.
TEST(Gjk, TriangleThatCrossesASliver) {
  const ConvexCore core(
      Triangle{Vector3d(0.17114305824844669, -0.070832143718264406, 0.075604388100735304),
               Vector3d(-0.073070756167903622, 0.12845783185099652, 0.21706014809197799),
               Vector3d(0.30529214694163365, -0.17693657590614809, -0.026778788753655663)});
  const Triangle sliver = {
      Vector3d(0.097863881263914834, -0.010914269146302644, 0.11828829142180715),
      Vector3d(0.097886382760231622, -0.01114359919032734, 0.11785116413932015),
      Vector3d(0.097884614586951718, -0.011125437227164728, 0.11788575081879075)};
  EXPECT_LT(closest_points(core, sliver).distance, 1e-15);
}

class AxisDistanceTrials : public testing::TestWithParam<std::size_t> {};

TEST_P(AxisDistanceTrials, NoNearestPairIsNearerTheTip) {
  Random random(100 + GetParam());
  for (int i = 0; i < 300 && !HasFailure(); ++i) {
    const Trial trial = oracle::make_trial(GetParam(), random);
    for (const ShaftAxis& axis : {trial.motion.start, trial.motion.end}) {
      double largest = std::max(axis.trocar.norm(), axis.tip.norm());
      for (const Vector3d& corner : trial.face) largest = std::max(largest, corner.norm());
      const double rounding = 1e-15 * largest + tolerance::kTie;  // [m]
      const ClosestPoints found = axis_closest_points(axis, trial.face);
      const double nearest = oracle::distance(oracle::core(axis), trial.face);
      EXPECT_NEAR(found.distance, nearest, rounding);
      const double place = found.shaft + 1e-3;
      if (place > 1.0 || axis.tip == axis.trocar) continue;
      const double rest =
          oracle::distance(oracle::core(ShaftAxis{axis.at(place), axis.tip}), trial.face);
      EXPECT_GT(rest, found.distance - rounding);
      EXPECT_GT(rest - nearest, 1e-17) << "at least as near beyond " << found.shaft;
    }
    if (HasFailure()) ADD_FAILURE() << oracle::to_line(trial);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, AxisDistanceTrials,
                         testing::Range<std::size_t>(0, oracle::trial_kinds().size()));

/// [m] By how much a distance may be too large. It is larger than the documented 1e-12 because of
/// slivers that lie along each other, and discs.
constexpr double kSlack = 2e-9;

class CoreTrials : public oracle::LinkTrials {};

TEST_P(CoreTrials, AreAsNearAsTheOracleSaysAndTheirFieldsFitTogether) {
  for_each_trial(150, [](const LinkTrial& trial, Random& /*random*/) {
    const ConvexCore core = trial.start * trial.core;
    const ClosestPoints found = closest_points(core, trial.face);
    const double distance = oracle::distance(core, trial.face);
    const double rounding = 20.0 * oracle::rounding(trial), slack = 1e-10 + rounding;
    EXPECT_GE(found.distance, distance - 1e-13 - rounding);
    EXPECT_LE(found.distance, distance + kSlack);
    EXPECT_GE(found.barycentric.minCoeff(), 0.0);
    EXPECT_NEAR(found.barycentric.sum(), 1.0, 1e-15);
    EXPECT_LE((found.on_face - point_at(trial.face, found.barycentric)).norm(), slack);
    EXPECT_NEAR((found.on_face - found.on_core).norm(), found.distance, slack);
    EXPECT_LE(oracle::distance(core, found.on_core), slack);
    if (!core.is_axis()) {
      EXPECT_EQ(found.shaft, 0.0);
    }
  });
}

TEST_P(CoreTrials, BeyondTheDistanceBoundTheResultIsALowerBound) {
  for_each_trial(150, [](const LinkTrial& trial, Random& random) {
    const ConvexCore core = trial.start * trial.core;
    const double slack = 1e-12 + oracle::rounding(trial);
    const double distance = closest_points(core, trial.face).distance;
    const double bound = distance * random.uniform(0.0, 1.5) + random.scale(1e-9, 1e-3);
    const double found = closest_points(core, trial.face, bound).distance;
    EXPECT_LE(found, distance + slack);
    if (distance <= bound) {
      EXPECT_EQ(found, distance) << "the search must not stop early";
    } else {
      EXPECT_GT(found, bound);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, CoreTrials, oracle::LinkTrials::all());

/// A triangle of a length [m] that is nearly a segment. Some of its points are near the origin.
Triangle needle(double length, Random& random) {
  const Vector3d along = length * random.direction(), start = -random.uniform(0.0, 1.0) * along;
  const Vector3d corner = start + random.uniform(-0.2, 1.2) * along +
                          length * random.scale(1e-12, 1e-1) * random.direction();
  Triangle face{start, start + along, corner};
  std::rotate(face.begin(), face.begin() + random.integer(0, 2), face.end());
  return face;
}

// Axes and triangles beside needles. Some cross them.
TEST(ClosestPoints, OfNeedlesAreExactToABillionthOfTheirLength) {
  Random random(17);
  for (const double length : {1e-3, 0.1, 1.0, 10.0, 100.0, 1000.0}) {
    for (int i = 0; i < 2000 && !HasFailure(); ++i) {
      const Triangle face = needle(length, random);
      Triangle core = needle(length * random.scale(1e-5, 1.0), random);
      const Vector3d beside = length * random.scale(1e-10, 1e-2) * random.direction();
      for (Vector3d& corner : core) corner += beside;
      if (random.chance(0.5)) core[2] = core[1];
      const ConvexCore shape =
          core[2] == core[1] ? ConvexCore(ShaftAxis{core[0], core[1]}) : ConvexCore(core);
      const double found = closest_points(shape, face).distance;
      EXPECT_GE(found, oracle::distance(core, face) - 1e-15 * length);
      EXPECT_LE(found, oracle::distance(core, face) + 1e-9 * length);
      if (HasFailure()) {
        const auto at_rest = Eigen::Isometry3d::Identity();
        ADD_FAILURE() << LinkTrial{shape, at_rest, at_rest, face, 0.0};
      }
    }
  }
}

}  // namespace
}  // namespace organ_collision
