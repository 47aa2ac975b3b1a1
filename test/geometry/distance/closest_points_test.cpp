#include "geometry/distance/closest_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "test/proof/core_distance_oracle.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;
using oracle::Trial;

/// [m] What doubles lose: some roundings of the largest coordinate.
double rounding(const Trial& trial) {
  double largest = 0.0;
  for (const ShaftAxis& axis : {trial.motion.start, trial.motion.end})
    largest = std::max({largest, axis.trocar.norm(), axis.tip.norm()});
  for (const Vector3d& corner : trial.face) largest = std::max(largest, corner.norm());
  return 1e-15 * largest;
}

Vector3d on(const Triangle& face, const Vector3d& barycentric) {
  return barycentric[0] * face[0] + barycentric[1] * face[1] + barycentric[2] * face[2];
}

/// The fields describe one pair of points of axis and face.
void expect_consistent(const ClosestPoints& found, const ShaftAxis& axis, const Triangle& face,
                       double slack) {
  EXPECT_GE(found.shaft, 0.0);
  EXPECT_LE(found.shaft, 1.0);
  EXPECT_GE(found.barycentric.minCoeff(), 0.0);
  EXPECT_NEAR(found.barycentric.sum(), 1.0, 1e-15);
  EXPECT_LE((found.on_face - on(face, found.barycentric)).norm(), slack);
  EXPECT_LE((found.on_core - axis.at(found.shaft)).norm(), slack);
  EXPECT_NEAR((found.on_face - found.on_core).norm(), found.distance, slack);
}

class ClosestPointsTrials : public testing::TestWithParam<std::size_t> {
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

TEST_P(ClosestPointsTrials, AreAsNearAsExactArithmeticSays) {
  for_each_axis([](const Trial& trial, const ShaftAxis& axis) {
    const ClosestPoints found = closest_points(axis, trial.face);
    expect_consistent(found, axis, trial.face, 4 * rounding(trial));
    EXPECT_NEAR(found.distance, oracle::distance(oracle::core(axis), trial.face),
                rounding(trial) + tolerance::kTie);
  });
}

TEST_P(ClosestPointsTrials, NoNearestPairIsNearerTheTip) {
  for_each_axis([](const Trial& trial, const ShaftAxis& axis) {
    const ClosestPoints found = closest_points(axis, trial.face);
    const double place = found.shaft + 1e-3;
    if (place > 1.0 || axis.tip == axis.trocar) return;
    const double rest =
        oracle::distance(oracle::core(ShaftAxis{axis.at(place), axis.tip}), trial.face);
    EXPECT_GT(rest, found.distance - rounding(trial) - tolerance::kTie);
    const double nearest = oracle::distance(oracle::core(axis), trial.face);
    EXPECT_GT(rest - nearest, 1e-17) << "at least as near beyond " << found.shaft;
  });
}

TEST_P(ClosestPointsTrials, OrderOfCornersOnlyPermutesBarycentrics) {
  constexpr std::array<std::array<int, 3>, 5> kOrders = {
      {{0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for_each_axis([&](const Trial& trial, const ShaftAxis& axis) {
    const ClosestPoints found = closest_points(axis, trial.face);
    for (const auto& order : kOrders) {
      const Triangle face = {trial.face[order[0]], trial.face[order[1]], trial.face[order[2]]};
      const ClosestPoints other = closest_points(axis, face);
      EXPECT_NEAR(other.distance, found.distance, 1e-15 + rounding(trial));
      EXPECT_NEAR(other.shaft, found.shaft, 1e-6);
      EXPECT_LE((other.on_face - found.on_face).norm(), 1e-7);
    }
  });
}

TEST_P(ClosestPointsTrials, ReversedAxisIsAsNear) {
  for_each_axis([](const Trial& trial, const ShaftAxis& axis) {
    EXPECT_NEAR(closest_points({axis.tip, axis.trocar}, trial.face).distance,
                closest_points(axis, trial.face).distance, rounding(trial) + tolerance::kTie);
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, ClosestPointsTrials,
                         testing::Range<std::size_t>(0, oracle::trial_kinds().size()));

/// [m] How far a core's nearest points may be too far apart, as this test finds: more than the
/// documented 1e-12 where slivers lie along each other, or discs stop short of it.
constexpr double kSlack = 2e-9;

/// With a kind of trials and a kind of core.
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
  });
}

TEST_P(CoreTrials, LieOnCoreAndFace) {
  for_each_core(150, [](const LinkTrial& trial, const ConvexCore& core, Random& /*random*/) {
    const double slack = 1e-10 + 20.0 * oracle::rounding(trial);
    const ClosestPoints found = closest_points(core, trial.face);
    EXPECT_GE(found.barycentric.minCoeff(), 0.0);
    EXPECT_NEAR(found.barycentric.sum(), 1.0, 1e-15);
    EXPECT_LE((found.on_face - on(trial.face, found.barycentric)).norm(), slack);
    EXPECT_LE(oracle::distance(core, found.on_core), slack);
    EXPECT_NEAR((found.on_face - found.on_core).norm(), found.distance, slack);
    if (!core.is_axis()) {
      EXPECT_EQ(found.shaft, 0.0);
    }
  });
}

// Where they are well apart, a plane across the way between the points parts core and face by it.
TEST_P(CoreTrials, NothingIsNearerThanThePlaneBetweenThem) {
  for_each_core(300, [](const LinkTrial& trial, const ConvexCore& core, Random& /*random*/) {
    const ClosestPoints found = closest_points(core, trial.face);
    if (found.distance < 1e-2) return;
    const Vector3d normal = (found.on_face - found.on_core) / found.distance;
    double nearest = INFINITY, size = 0.0;
    for (const Vector3d& corner : trial.face) {
      nearest = std::min(nearest, normal.dot(corner));
      size = std::max(size, (corner - trial.face[0]).norm());
    }
    EXPECT_GE(nearest - core.height(normal), found.distance - kSlack * (1.0 + 10.0 * size));
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

TEST_P(CoreTrials, MovingBothRigidlyChangesNothing) {
  for_each_core(100, [](const LinkTrial& trial, const ConvexCore& core, Random& random) {
    const Eigen::Isometry3d pose = oracle::random_pose(0.3, random);
    const Triangle& face = trial.face;
    const ClosestPoints found = closest_points(core, face);
    const ClosestPoints moved =
        closest_points(pose * core, {pose * face[0], pose * face[1], pose * face[2]});
    EXPECT_NEAR(moved.distance, found.distance, kSlack + 20.0 * oracle::rounding(trial));
    if (found.distance > 1e-3) {  // the direction between the points is unique, not the points
      EXPECT_LE(
          (moved.on_face - moved.on_core - pose.linear() * (found.on_face - found.on_core)).norm(),
          1e-5);
    }
  });
}

TEST_P(CoreTrials, EnoughIsALowerBoundAboveIt) {
  for_each_core(150, [](const LinkTrial& trial, const ConvexCore& core, Random& random) {
    const double slack = 1e-12 + oracle::rounding(trial);
    const double distance = closest_points(core, trial.face).distance;
    const double enough = distance * random.uniform(0.0, 1.5) + random.scale(1e-9, 1e-3);
    const double found = closest_points(core, trial.face, enough).distance;
    EXPECT_LE(found, distance + slack);
    if (distance <= enough) {
      EXPECT_EQ(found, distance) << "nothing was cut short";
    } else {
      EXPECT_GT(found, enough);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, CoreTrials,
    testing::Combine(testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()),
                     testing::Range<std::size_t>(0, oracle::kCoreKinds)));

const Triangle kFace = {Vector3d(0.1, 0.1, 0.5), Vector3d(0.5, 0.1, 0.5), Vector3d(0.1, 0.3, 0.5)};

TEST(ClosestPoints, AxisAlongTheFaceIsNearestWhereItLeavesItTowardsTheTip) {
  const ClosestPoints found = closest_points({{0.0, 0.2, 0.53}, {1.0, 0.2, 0.53}}, kFace);
  EXPECT_NEAR(found.distance, 0.03, 1e-15);
  EXPECT_NEAR(found.shaft, 0.3, 1e-15);
  EXPECT_TRUE(found.on_face.isApprox(Vector3d(0.3, 0.2, 0.5), 1e-15));
  EXPECT_TRUE(found.barycentric.isApprox(Vector3d(0.0, 0.5, 0.5), 1e-14));
}

TEST(ClosestPoints, AxisAlongAnEdgeIsNearestAtTheEdgesLastCorner) {
  const ClosestPoints found = closest_points({{0.9, 0.0, 0.5}, {-0.1, 0.0, 0.5}}, kFace);
  EXPECT_NEAR(found.distance, 0.1, 1e-15);
  EXPECT_NEAR(found.shaft, 0.8, 1e-15);
  EXPECT_EQ(found.barycentric, Vector3d(1.0, 0.0, 0.0));
}

TEST(ClosestPoints, AxisInTheFacesPlanePiercesItWhereItLeaves) {
  const ClosestPoints found = closest_points({{0.2, 0.0, 0.5}, {0.2, 1.0, 0.5}}, kFace);
  EXPECT_NEAR(found.distance, 0.0, 1e-15);
  EXPECT_NEAR(found.shaft, 0.25, 1e-15);
}

TEST(ClosestPoints, TipOverTheInside) {
  const ClosestPoints found = closest_points({{0.9, 0.8, 1.0}, {0.2, 0.15, 0.51}}, kFace);
  EXPECT_NEAR(found.distance, 0.01, 1e-15);
  EXPECT_EQ(found.shaft, 1.0);
  EXPECT_TRUE(found.barycentric.isApprox(Vector3d(0.5, 0.25, 0.25), 1e-14));
}

TEST(ClosestPoints, BallAndPointHaveOneNearestPair) {
  const Vector3d center(0.3, 0.7, 0.2), corner(0.3, 0.4, 0.6);
  const ClosestPoints found = closest_points({center, center}, {corner, corner, corner});
  EXPECT_NEAR(found.distance, 0.5, 1e-15);
  EXPECT_EQ(found.shaft, 1.0);
  EXPECT_EQ(found.on_core, center);
  EXPECT_EQ(found.on_face, corner);
}

TEST(ClosestPoints, OfASolidAndWhatItHoldsAreTogether) {
  const ConvexCore box = LinkPart::box(Eigen::Isometry3d::Identity(), {0.1, 0.2, 0.3}).core;
  const ConvexCore can = LinkPart::cylinder(Eigen::Isometry3d::Identity(), 0.1, 0.3).core;
  const Triangle inside = {Vector3d(0.01, 0.02, 0.1), Vector3d(0.02, -0.03, 0.1),
                           Vector3d(-0.01, 0.01, -0.1)};
  EXPECT_EQ(closest_points(box, inside).distance, 0.0);
  EXPECT_EQ(closest_points(can, inside).distance, 0.0);
}

// The faces lie flat on each other, side by side, corner to corner.
TEST(ClosestPoints, OfABoxOverAFace) {
  const ConvexCore box = LinkPart::box(Eigen::Isometry3d::Identity(), {0.2, 0.2, 0.2}).core;
  const auto face = [](double x, double y, double z) {
    return Triangle{Vector3d(x, y, z), Vector3d(x + 0.3, y, z), Vector3d(x, y + 0.3, z)};
  };
  EXPECT_NEAR(closest_points(box, face(-0.1, -0.1, 0.13)).distance, 0.03, 1e-16);
  EXPECT_NEAR(closest_points(box, face(-0.15, -0.15, 0.1)).distance, 0.0, 1e-16);
  EXPECT_NEAR(closest_points(box, face(0.14, -0.1, 0.13)).distance, 0.05, 1e-16);
  const ClosestPoints corners = closest_points(box, face(0.11, 0.12, 0.12));
  EXPECT_NEAR(corners.distance, 0.03, 1e-16);
  EXPECT_TRUE(corners.on_core.isApprox(Vector3d(0.1, 0.1, 0.1), 1e-15));
  EXPECT_TRUE(corners.barycentric.isApprox(Vector3d(1.0, 0.0, 0.0), 1e-15));
}

// Simplices of this sliver lose their last digits: the iteration once ended 5e-9 m away.
TEST(ClosestPoints, OfATriangleAndASliverThatItCrosses) {
  ConvexCore core;
  core.count = 3;
  core.points[0] = {0.17114305824844669, -0.070832143718264406, 0.075604388100735304};
  core.points[1] = {-0.073070756167903622, 0.12845783185099652, 0.21706014809197799};
  core.points[2] = {0.30529214694163365, -0.17693657590614809, -0.026778788753655663};
  const Triangle sliver = {
      Vector3d(0.097863881263914834, -0.010914269146302644, 0.11828829142180715),
      Vector3d(0.097886382760231622, -0.01114359919032734, 0.11785116413932015),
      Vector3d(0.097884614586951718, -0.011125437227164728, 0.11788575081879075)};
  EXPECT_LT(closest_points(core, sliver).distance, 1e-15);
}

}  // namespace
}  // namespace organ_collision
