#include "geometry/distance/closest_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "test/proof/core_distance_oracle.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

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
  });
}

TEST_P(CoreTrials, LieOnCoreAndFace) {
  for_each_core(150, [](const LinkTrial& trial, const ConvexCore& core, Random& /*random*/) {
    const double slack = 1e-10 + 20.0 * oracle::rounding(trial);
    const ClosestPoints found = closest_points(core, trial.face);
    EXPECT_GE(found.barycentric.minCoeff(), 0.0);
    EXPECT_NEAR(found.barycentric.sum(), 1.0, 1e-15);
    EXPECT_LE((found.on_face - point_at(trial.face, found.barycentric)).norm(), slack);
    EXPECT_LE(oracle::distance(core, found.on_core), slack);
    EXPECT_NEAR((found.on_face - found.on_core).norm(), found.distance, slack);
    if (!core.is_axis()) {
      EXPECT_EQ(found.shaft, 0.0);
    }
  });
}

// If core and face are clearly separated, the plane at right angles to the separation separates
// them by the whole distance.
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
    EXPECT_GE(nearest - core.support_value(normal), found.distance - kSlack * (1.0 + 10.0 * size));
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
    if (found.distance > 1e-3) {  // The separation is unique; the points need not be.
      EXPECT_LE(
          (moved.on_face - moved.on_core - pose.linear() * (found.on_face - found.on_core)).norm(),
          1e-5);
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
