#include "geometry/distance/axis_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;
using oracle::Trial;

/// [m] The rounding error of doubles: a few roundings of the largest coordinate.
double rounding(const Trial& trial) {
  double largest = 0.0;
  for (const ShaftAxis& axis : {trial.motion.start, trial.motion.end})
    largest = std::max({largest, axis.trocar.norm(), axis.tip.norm()});
  for (const Vector3d& corner : trial.face) largest = std::max(largest, corner.norm());
  return 1e-15 * largest;
}

/// Checks that the fields describe one pair of points of axis and face.
void expect_consistent(const ClosestPoints& found, const ShaftAxis& axis, const Triangle& face,
                       double slack) {
  EXPECT_GE(found.shaft, 0.0);
  EXPECT_LE(found.shaft, 1.0);
  EXPECT_GE(found.barycentric.minCoeff(), 0.0);
  EXPECT_NEAR(found.barycentric.sum(), 1.0, 1e-15);
  EXPECT_LE((found.on_face - point_at(face, found.barycentric)).norm(), slack);
  EXPECT_LE((found.on_core - axis.at(found.shaft)).norm(), slack);
  EXPECT_NEAR((found.on_face - found.on_core).norm(), found.distance, slack);
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

TEST_P(AxisDistanceTrials, OrderOfCornersOnlyPermutesBarycentrics) {
  constexpr std::array<std::array<int, 3>, 5> kOrders = {
      {{0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for_each_axis([&](const Trial& trial, const ShaftAxis& axis) {
    const ClosestPoints found = axis_closest_points(axis, trial.face);
    for (const auto& order : kOrders) {
      const Triangle face = {trial.face[order[0]], trial.face[order[1]], trial.face[order[2]]};
      const ClosestPoints other = axis_closest_points(axis, face);
      EXPECT_NEAR(other.distance, found.distance, 1e-15 + rounding(trial));
      EXPECT_NEAR(other.shaft, found.shaft, 1e-6);
      EXPECT_LE((other.on_face - found.on_face).norm(), 1e-7);
    }
  });
}

TEST_P(AxisDistanceTrials, ReversedAxisIsAsNear) {
  for_each_axis([](const Trial& trial, const ShaftAxis& axis) {
    EXPECT_NEAR(axis_closest_points({axis.tip, axis.trocar}, trial.face).distance,
                axis_closest_points(axis, trial.face).distance, rounding(trial));
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

TEST(AxisDistance, AxisAlongAnEdgeIsNearestAtTheEdgesLastCorner) {
  const ClosestPoints found = axis_closest_points({{0.9, 0.0, 0.5}, {-0.1, 0.0, 0.5}}, kFace);
  EXPECT_NEAR(found.distance, 0.1, 1e-15);
  EXPECT_NEAR(found.shaft, 0.8, 1e-15);
  EXPECT_EQ(found.barycentric, Vector3d(1.0, 0.0, 0.0));
}

TEST(AxisDistance, AxisInTheFacesPlanePiercesItWhereItLeaves) {
  const ClosestPoints found = axis_closest_points({{0.2, 0.0, 0.5}, {0.2, 1.0, 0.5}}, kFace);
  EXPECT_NEAR(found.distance, 0.0, 1e-15);
  EXPECT_NEAR(found.shaft, 0.25, 1e-15);
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

TEST(AxisDistance, TipOverTheInside) {
  const ClosestPoints found = axis_closest_points({{0.9, 0.8, 1.0}, {0.2, 0.15, 0.51}}, kFace);
  EXPECT_NEAR(found.distance, 0.01, 1e-15);
  EXPECT_EQ(found.shaft, 1.0);
  EXPECT_TRUE(found.barycentric.isApprox(Vector3d(0.5, 0.25, 0.25), 1e-14));
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

TEST(AxisDistance, AnEndWithinAFaceAcrossIsNearestForBothSidesOfTheFace) {
  const Vector3d middle(0.25, 0.15, 0.5), beyond(0.25, 0.15, 1.0);
  const Triangle turned = {kFace[0], kFace[2], kFace[1]};
  for (const Triangle& face : {kFace, turned}) {
    EXPECT_NEAR(axis_closest_points({middle, beyond}, face).distance, 0.0, 1e-15);
    EXPECT_NEAR(axis_closest_points({beyond, middle}, face).distance, 0.0, 1e-15);
  }
}

TEST(AxisDistance, BallAndPointHaveOneNearestPair) {
  const Vector3d center(0.3, 0.7, 0.2), corner(0.3, 0.4, 0.6);
  const ClosestPoints found = axis_closest_points({center, center}, {corner, corner, corner});
  EXPECT_NEAR(found.distance, 0.5, 1e-15);
  EXPECT_EQ(found.shaft, 1.0);
  EXPECT_EQ(found.on_core, center);
  EXPECT_EQ(found.on_face, corner);
}

}  // namespace
}  // namespace organ_collision
