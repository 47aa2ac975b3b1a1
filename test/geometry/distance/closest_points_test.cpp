#include "geometry/distance/closest_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"
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

// The last tetrahedron of the iteration is flat. By its weights, which are noise, it once contained
// the origin.
TEST(Gjk, ANeedleBesideAnotherTriangleIsNotTouched) {
  const ConvexCore core(
      Triangle{Vector3d(-0.046553552150726318, -0.032878760248422623, -0.049334641546010971),
               Vector3d(-0.046553418040275574, -0.032878056168556213, -0.049335330724716187),
               Vector3d(-0.046556729823350906, -0.032880809158086777, -0.049332257360219955)});
  const Triangle needle = {
      Vector3d(-0.04655511091627338, -0.03287965463862242, -0.049333442159874084),
      Vector3d(-0.22891719784133702, 0.026288247141443406, 0.17858188568535618),
      Vector3d(-0.046556059741531652, -0.032879138507067696, -0.049331983062160856)};
  EXPECT_NEAR(closest_points(core, needle).distance, 9.75e-8, 1e-10);
}

/// [m] The rounding error of doubles: a few roundings of the largest coordinate.
double rounding(const Trial& trial) {
  double largest = 0.0;
  for (const ShaftAxis& axis : {trial.motion.start, trial.motion.end})
    largest = std::max({largest, axis.trocar.norm(), axis.tip.norm()});
  for (const Vector3d& corner : trial.face) largest = std::max(largest, corner.norm());
  return 1e-15 * largest;
}

/// Checks that the fields describe one pair of points of core and face.
void expect_consistent(const ClosestPoints& found, const ConvexCore& core, const Triangle& face,
                       double slack) {
  EXPECT_GE(found.barycentric.minCoeff(), 0.0);
  EXPECT_NEAR(found.barycentric.sum(), 1.0, 1e-15);
  EXPECT_LE((found.on_face - point_at(face, found.barycentric)).norm(), slack);
  EXPECT_NEAR((found.on_face - found.on_core).norm(), found.distance, slack);
  if (core.is_axis()) {
    EXPECT_GE(found.shaft, 0.0);
    EXPECT_LE(found.shaft, 1.0);
    EXPECT_LE((found.on_core - core.axis().at(found.shaft)).norm(), slack);
  } else {
    EXPECT_EQ(found.shaft, 0.0);
    EXPECT_LE(oracle::distance(core, found.on_core), slack);
  }
}

class AxisDistanceTrials : public testing::TestWithParam<std::size_t> {
 protected:
  /// Calls `check(trial, axis)` with the axes of some trials.
  template <typename Check>
  void for_each_axis(Check check) {
    Random random(100 + GetParam());
    for (int i = 0; i < 300 && !HasFailure(); ++i) {
      const Trial trial = oracle::make_trial(GetParam(), random);
      for (const ShaftAxis& axis : {trial.motion.start, trial.motion.end}) check(trial, axis);
      if (HasFailure()) ADD_FAILURE() << oracle::to_line(trial);
    }
  }
};

TEST_P(AxisDistanceTrials, AreAsNearAsExactArithmeticSays) {
  for_each_axis([](const Trial& trial, const ShaftAxis& axis) {
    const ClosestPoints found = axis_closest_points(axis, trial.face);
    expect_consistent(found, axis, trial.face, 4 * rounding(trial));
    EXPECT_NEAR(found.distance, oracle::distance(oracle::core(axis), trial.face),
                rounding(trial) + tolerance::kTie);
  });
}

TEST_P(AxisDistanceTrials, NoNearestPairIsNearerTheTip) {
  for_each_axis([](const Trial& trial, const ShaftAxis& axis) {
    const ClosestPoints found = axis_closest_points(axis, trial.face);
    const double place = found.shaft + 1e-3;
    if (place > 1.0 || axis.tip == axis.trocar) return;
    const double rest =
        oracle::distance(oracle::core(ShaftAxis{axis.at(place), axis.tip}), trial.face);
    EXPECT_GT(rest, found.distance - rounding(trial) - tolerance::kTie);
    const double nearest = oracle::distance(oracle::core(axis), trial.face);
    EXPECT_GT(rest - nearest, 1e-17) << "at least as near beyond " << found.shaft;
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, AxisDistanceTrials,
                         testing::Range<std::size_t>(0, oracle::trial_kinds().size()));

const Triangle kFace = {Vector3d(0.1, 0.1, 0.5), Vector3d(0.5, 0.1, 0.5), Vector3d(0.1, 0.3, 0.5)};

TEST(AxisDistance, AxisAlongTheFaceIsNearestWhereItLeavesItTowardsTheTip) {
  const ClosestPoints found = axis_closest_points({{0.0, 0.2, 0.53}, {1.0, 0.2, 0.53}}, kFace);
  EXPECT_NEAR(found.distance, 0.03, 1e-15);
  EXPECT_NEAR(found.shaft, 0.3, 1e-15);
  EXPECT_TRUE(found.on_face.isApprox(Vector3d(0.3, 0.2, 0.5), 1e-15));
  EXPECT_TRUE(found.barycentric.isApprox(Vector3d(0.0, 0.5, 0.5), 1e-14));
}

// Both ends are tied. The point is at the tip, and the trocar decides how near the axis is.
TEST(AxisDistance, OfATieIsTheLeastOfItsPairs) {
  const Triangle face = {Vector3d(-1.0, -1.0, 0.0), Vector3d(1.0, -1.0, 0.0),
                         Vector3d(1.0, 1.0, 0.0)};
  const Vector3d low(0.0, 0.0, 0.005), high(0.1, 0.0, 0.005 + 9e-13);
  for (const ShaftAxis& axis : {ShaftAxis{low, high}, ShaftAxis{high, low}}) {
    const ClosestPoints found = axis_closest_points(axis, face);
    EXPECT_EQ(found.distance, 0.005);
    EXPECT_EQ(found.shaft, 1.0);
  }
}

// Only an end of the axis is near the inside of such a face, if it does not pierce it.
TEST(AxisDistance, AcrossAFaceNearOneOfItsEnds) {
  Random random(11);
  for (const double length : {1.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-18, 0.0}) {
    for (const double place : {-1e-2, -1e-16, 0.0, 1e-16, 1e-8, 1e-3, 0.5, 1.0 - 1e-3, 1.0 - 1e-8,
                               1.0 - 1e-16, 1.0, 1.0 + 1e-16, 1.0 + 1e-2}) {
      for (const double tilt : {0.0, 1e-17, 1e-12, 1e-6}) {
        const Vector3d along = random.direction(), trocar = random.point(0.1);
        const Vector3d u = 0.05 * along.cross(random.direction()).normalized();
        const Vector3d v = along.cross(u) + tilt * along;
        const Vector3d crossing = trocar + place * length * along;
        const ShaftAxis axis{trocar, trocar + length * along};
        const Triangle face{crossing + u, crossing - 0.5 * u + v, crossing - 0.5 * u - v};
        EXPECT_NEAR(axis_closest_points(axis, face).distance,
                    oracle::distance(oracle::core(axis), face), 1e-15 + tolerance::kTie)
            << "length " << length << ", place " << place << ", tilt " << tilt;
      }
    }
  }
}

// Rounding hides some of these piercings. An end of the axis is then the nearest point that is
// found.
TEST(AxisDistance, PiercingASliverMuchLongerThanItself) {
  Random random(5);
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) {
    const double length = random.scale(1e-4, 1.0), reach = length * random.scale(1e2, 1e4);
    const double width = length * random.scale(3e-3, 1e-1);
    const double share = 1e-3 * random.uniform(1.001, 2.0);
    const Vector3d along = random.direction();
    const Vector3d u = along.cross(random.direction()).normalized(), v = along.cross(u);
    const Vector3d crossing = share * length * along;
    const ShaftAxis axis{Vector3d::Zero(), length * along};
    const Triangle face{crossing - reach * u, crossing + reach * u + width * v,
                        crossing + reach * u - width * v};
    // The trocar is as near as its distance from the plane of the face, except for rounding.
    EXPECT_LE(axis_closest_points(axis, face).distance, 1.1 * share * length) << reach / length;
  }
}

/// [m] By how much a distance may be too large. It is larger than the documented 1e-12 because of
/// slivers that lie along each other, and discs.
constexpr double kSlack = 2e-9;

/// For each kind of trials and each kind of core.
class CoreTrials : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {
 protected:
  /// Calls `check(trial, core in the organ's frame, random)`.
  template <typename Check>
  void for_each_core(int count, Check check) {
    const auto [kind, core_kind] = GetParam();
    Random random(600 + 10 * kind + core_kind);
    for (int i = 0; i < count && !HasFailure(); ++i) {
      const LinkTrial trial = oracle::make_link_trial(kind, core_kind, random);
      check(trial, trial.start * trial.core, random);
      if (HasFailure()) ADD_FAILURE() << trial;
    }
  }
};

TEST_P(CoreTrials, AreAsNearAsTheOracleSays) {
  for_each_core(150, [](const LinkTrial& trial, const ConvexCore& core, Random& /*random*/) {
    const ClosestPoints found = closest_points(core, trial.face);
    const double distance = oracle::distance(core, trial.face);
    EXPECT_GE(found.distance, distance - 1e-13 - oracle::rounding(trial) * 20.0);
    EXPECT_LE(found.distance, distance + kSlack);
    expect_consistent(found, core, trial.face, 1e-10 + 20.0 * oracle::rounding(trial));
  });
}

TEST_P(CoreTrials, OrderOfCornersOnlyPermutesBarycentrics) {
  for_each_core(100, [](const LinkTrial& trial, const ConvexCore& core, Random& /*random*/) {
    const double distance = closest_points(core, trial.face).distance;
    for (int turn = 0; turn < 3; ++turn) {
      for (const bool mirror : {false, true}) {
        Triangle face = trial.face;
        std::rotate(face.begin(), face.begin() + turn, face.end());
        if (mirror) std::swap(face[1], face[2]);
        EXPECT_NEAR(closest_points(core, face).distance, distance, kSlack);
      }
    }
  });
}

TEST_P(CoreTrials, BeyondTheDistanceBoundTheResultIsALowerBound) {
  for_each_core(150, [](const LinkTrial& trial, const ConvexCore& core, Random& random) {
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

INSTANTIATE_TEST_SUITE_P(
    Kinds, CoreTrials,
    testing::Combine(testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()),
                     testing::Range<std::size_t>(0, oracle::kCoreKinds)));

}  // namespace
}  // namespace organ_collision
