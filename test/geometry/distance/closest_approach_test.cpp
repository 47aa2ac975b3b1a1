#include "geometry/distance/closest_approach.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "test/geometry/tool/tool_meshes.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/step_oracle.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

constexpr double kAny = std::numeric_limits<double>::infinity();

std::optional<ClosestApproach> approach(const CoreMotion& core, const FaceMotion& face,
                                        double distance_bound = kAny) {
  WorkBudget unlimited = WorkBudget::unlimited();
  return closest_approach(core, face, distance_bound, unlimited);
}

FaceMotion some_motion(const Triangle& face, Random& random) {
  FaceMotion motion{face, face};
  if (random.chance(0.5)) return motion;
  for (Vector3d& corner : motion.start) corner += random.scale(1e-5, 0.05) * random.direction();
  return motion;
}

/// The oracle halves the leg until the speed of the fastest corner decides. It must not find that
/// the distance certainly falls more than 1e-6 m below the one found.
void expect_least(double least, LinkTrial trial, const FaceMotion& face) {
  const double slack = 1e-7 + 1000.0 * oracle::rounding(trial);
  trial.radius = least - 1e-6 - slack;
  if (trial.radius <= slack) return;  // Nothing is nearer than zero.
  EXPECT_FALSE(oracle::first_time_within(trial, face, slack).certainly) << trial;
}

TEST(ClosestApproach, OfLinksIsTheLeastDistance) {
  Random random(1);
  for (int i = 0; i < 4000; ++i) {
    const auto kind = static_cast<std::size_t>(i) % oracle::link_trial_kinds().size();
    const auto core_kind = static_cast<std::size_t>(random.integer(0, oracle::kCoreKinds - 1));
    const LinkTrial trial = oracle::make_link_trial(kind, core_kind, random);
    SCOPED_TRACE(testing::Message() << trial);
    const FaceMotion face = some_motion(trial.face, random);
    const RigidMotion motion = trial.motion();
    const CoreMotion core(trial.core, motion);
    const auto found = approach(core, face);
    ASSERT_TRUE(found);
    EXPECT_GE(found->time, 0.0);
    EXPECT_LE(found->time, 1.0);
    const double there =
        closest_points(oracle::pose_at(trial, found->time) * trial.core, face.at(found->time))
            .distance;
    EXPECT_NEAR(found->closest.distance, there, 1e-9 + 1000.0 * oracle::rounding(trial));
    expect_least(found->closest.distance, trial, face);
  }
}

TEST(ClosestApproach, IsFoundOnlyWithinTheBound) {
  Random random(4);
  int found_count = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto core_kind = static_cast<std::size_t>(i) % oracle::kCoreKinds;
    const LinkTrial trial = oracle::make_link_trial(1, core_kind, random);
    SCOPED_TRACE(testing::Message() << trial);
    const FaceMotion face = some_motion(trial.face, random);
    const RigidMotion motion = trial.motion();
    const CoreMotion core(trial.core, motion);
    const double least = approach(core, face)->closest.distance;
    const double bound = least * random.uniform(0.5, 1.5);
    const auto found = approach(core, face, bound);
    if (bound > least + 2.0 * tolerance::kApproach) {
      ASSERT_TRUE(found);
    }
    if (bound < least - 2.0 * tolerance::kApproach) {
      ASSERT_FALSE(found);
    }
    if (!found) continue;
    ++found_count;
    EXPECT_LE(found->closest.distance, bound);
    EXPECT_NEAR(found->closest.distance, least, 1.1 * tolerance::kApproach);
  }
  EXPECT_GT(found_count, 1000);
}

TEST(ClosestApproach, OfASurfaceIsThatOfItsNearestTriangle) {
  Random random(5);
  for (int i = 0; i < 400; ++i) {
    const ToolSurface surface =
        scattered_mesh(static_cast<std::size_t>(random.integer(1, 60)), random).surface();
    const LinkTrial trial = oracle::make_link_trial(1, 1, random);
    SCOPED_TRACE(testing::Message() << trial);
    const FaceMotion face = some_motion(trial.face, random);
    const RigidMotion motion =
        random.chance(0.5) ? trial.motion() : RigidMotion(trial.end, trial.end);
    double least = kAny;
    for (std::size_t triangle = 0; triangle < surface.faces().size(); ++triangle) {
      const CoreMotion core(ConvexCore(surface.triangle(triangle)), motion);
      least = std::min(least, approach(core, face)->closest.distance);
    }
    WorkBudget unlimited = WorkBudget::unlimited();
    const auto found = closest_approach(surface, motion, face, kAny, unlimited);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->closest.distance, least, 1.1 * tolerance::kApproach);
    const auto beyond = closest_approach(surface, motion, face, 0.9 * least - 1e-6, unlimited);
    EXPECT_FALSE(beyond);
  }
}

TEST(ClosestApproach, TakesFewStepsWhereTheDistanceIsNearlyConstant) {
  // A box turns about an axis at right angles to a face, and a shaft slides along one.
  const Triangle face = {Vector3d(-0.3, -0.2, 0.0), Vector3d(0.4, -0.1, 0.0),
                         Vector3d(0.0, 0.5, 0.0)};
  const LinkPart box = LinkPart::box(Eigen::Isometry3d::Identity(), {0.03, 0.02, 0.01});
  Eigen::Isometry3d start(Eigen::Translation3d(0.0, 0.0, 0.02));
  Eigen::Isometry3d end = start * Eigen::AngleAxisd(1.5, Vector3d::UnitZ());
  const RigidMotion turn(start, end);
  for (const CoreMotion& core :
       {CoreMotion(box.core, turn),
        CoreMotion(ShaftMotion{{{-0.05, 0.0, 0.1}, {-0.05, 0.01, 0.015}},
                               {{0.05, 0.0, 0.1}, {0.05, 0.01, 0.015}}})}) {
    WorkBudget budget;
    const auto found = closest_approach(core, {face, face}, kAny, budget);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->closest.distance, 0.015, 1e-6);
    EXPECT_LT(budget.spent(), 100U);
  }
}

TEST(ClosestApproach, EndsWhenTheBudgetIsUsedUp) {
  Random random(6);
  const LinkTrial trial = oracle::make_link_trial(1, 2, random);
  const RigidMotion motion = trial.motion();
  WorkBudget budget;
  budget.spend(2 * WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs);
  const auto found =
      closest_approach(CoreMotion(trial.core, motion), {trial.face, trial.face}, kAny, budget);
  ASSERT_TRUE(found);
  EXPECT_GE(
      found->closest.distance,
      approach(CoreMotion(trial.core, motion), {trial.face, trial.face})->closest.distance - 1e-6);
}

}  // namespace
}  // namespace organ_collision
