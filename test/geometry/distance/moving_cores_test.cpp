// How convex cores move past faces: first touch, closest approach, and planes that keep them apart.
// The proof of the contacts compares the first touches of shafts with exact arithmetic, and that of
// the clearance the closest approaches with a search.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/distance/first_touch.hpp"
#include "geometry/distance/separating_plane.hpp"
#include "geometry/distance/work_budget.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/step_oracle.hpp"
#include "test/proof/trial_suites.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

/// Expects that a budget is used up by its last step.
void expect_steps(WorkBudget budget, std::uint64_t pairs, std::uint64_t steps) {
  budget.add_pairs(pairs);
  budget.spend(steps - 1);
  EXPECT_FALSE(budget.is_used_up()) << pairs;
  budget.spend(1);
  EXPECT_TRUE(budget.is_used_up()) << pairs;
}

TEST(WorkBudget, GrowsWithThePairsBetweenTheLeastAndTheMost) {
  constexpr std::uint64_t kSteps = WorkBudget::kStepsForEachPair;
  constexpr std::uint64_t kLeast = WorkBudget::kLeastPairs, kMost = WorkBudget::kMostPairs;
  expect_steps(WorkBudget(), 0, kSteps * kLeast);
  expect_steps(WorkBudget(), kLeast, kSteps * kLeast);
  expect_steps(WorkBudget(), kLeast + 1, kSteps * (kLeast + 1));
  expect_steps(WorkBudget(), 1000 * kMost, kSteps * kMost);
  for (const std::uint64_t pairs : {std::uint64_t{0}, 1000 * kMost}) {
    expect_steps(WorkBudget::for_clearance(), pairs, WorkBudget::kClearanceSteps);
    expect_steps(WorkBudget::for_near(7, 3), pairs,
                 WorkBudget::kNearSteps + 7 * WorkBudget::kStepsForEachNearFace +
                     3 * WorkBudget::kStepsForEachLeg);
  }
  WorkBudget unlimited = WorkBudget::unlimited();
  unlimited.spend(std::uint64_t{1} << 60U);
  EXPECT_FALSE(unlimited.is_used_up());
}

/// A triangle of about this size that has the origin near it [m].
Triangle random_triangle(double size, Random& random) {
  const Vector3d middle = random.point(0.5 * size);
  return {middle + random.point(size), middle + random.point(size), middle + random.point(size)};
}

/// Compares the crossing of two triangles, if one was found, with the exact distance. Counts it.
void expect_true_crossing(const Triangle& core, const Triangle& face, int& crossings) {
  const auto crossing = triangle_crossing(core, face);
  if (!crossing) return;
  ++crossings;
  const double size = std::max(largest_coordinate(core), largest_coordinate(face));
  EXPECT_LE(crossing->distance, tolerance::kTie);
  EXPECT_LE(oracle::distance(ConvexCore(core), face), tolerance::kTie + 1e-15 * size);
  EXPECT_GE(crossing->barycentric.minCoeff(), 0.0);
  EXPECT_NEAR(crossing->barycentric.sum(), 1.0, 1e-15);
  EXPECT_EQ(crossing->on_face, point_at(face, crossing->barycentric));
  EXPECT_EQ(crossing->separation, crossing->on_face - crossing->on_core);
  EXPECT_EQ(crossing->separation.norm(), crossing->distance);
  EXPECT_LE(oracle::distance(ConvexCore(core), crossing->on_core), 1e-14 * (1.0 + size));
}

// Corners and edges on the other triangle, common corners and edges, slivers.
TEST(TriangleCrossing, IsTrueForTrianglesThatBarelyTouch) {
  Random random(2);
  int crossings = 0;
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
    expect_true_crossing(core, face, crossings);
    expect_true_crossing(face, core, crossings);
  }
  EXPECT_GT(crossings, 200);
}

/// Steps allowed for 1000 grazing shafts: three times what they need near the origin.
constexpr std::uint64_t kGrazingSteps = 135'000;

/// Spends the steps needed to decide on 1000 shafts that slide over faces, at the radius and up to
/// a few roundings more, within `far` [m] of the origin.
void graze(double far, WorkBudget& budget) {
  Random random(11);
  const auto over_plane = [&](double height) {
    return Vector3d(far * random.uniform(-0.5, 0.5), far * random.uniform(-0.5, 0.5), height);
  };
  for (int i = 0; i < 1000; ++i) {
    const double radius = random.uniform(0.01, 0.1) * far, size = 0.01 * far;
    const Vector3d corner = over_plane(0.0);
    const Triangle face = oracle::rounded(
        {corner, corner + size * Vector3d::UnitX(), corner + size * Vector3d::UnitY()});
    const ShaftAxis start{over_plane(radius + (i % 12) * 1.2e-16 * far),
                          over_plane(radius + (i % 12) * 1.2e-16 * far)};
    const Vector3d step =
        random.uniform(1.0, 2.0) * (face[0] - start.trocar).cwiseProduct(Vector3d(1.0, 1.0, 0.0));
    first_touch(ShaftMotion{start, {start.trocar + step, start.tip + step}}, {face, face}, radius,
                budget);
  }
}

// Far from the origin distances are rounded by more than kTouch. The search must not try to be more
// exact than that.
TEST(FirstTouch, GrazingNeedsLittleWorkFarFromTheOriginToo) {
  for (const double far : {1.0, 1e5, 4e5, 8e5}) {
    WorkBudget budget;
    budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs - kGrazingSteps);
    graze(far, budget);
    EXPECT_FALSE(budget.is_used_up()) << far;
  }
}

/// [m] A face whose distance is within this of the radius may touch or not. It includes the
/// rounding errors of planes along large faces and of distances far from the origin.
double band(const LinkTrial& trial) {
  const double size =
      (trial.face[1] - trial.face[0]).norm() + (trial.face[2] - trial.face[0]).norm();
  return 1e-9 * (1.0 + size) + 1000.0 * oracle::rounding(trial);
}

double distance_at(const LinkTrial& trial, const FaceMotion& face, double time) {
  return closest_points(oracle::pose_at(trial, time) * trial.core, face.at(time)).distance;
}

/// Expects that a touch is at the radius, not missed, and neither too early nor too late.
void expect_first(const std::optional<FirstTouch>& touch, const LinkTrial& trial,
                  const FaceMotion& face) {
  const oracle::FirstTime earliest = oracle::first_time_within(trial, face, band(trial));
  if (earliest.certainly) {
    EXPECT_TRUE(touch);
  }
  if (!earliest.possibly) {
    EXPECT_FALSE(touch);
  }
  if (!touch) return;
  EXPECT_GE(touch->time, earliest.possibly.value_or(2.0) - 1e-12);
  EXPECT_LE(touch->time, earliest.certainly.value_or(1.0) + 1e-12);
  EXPECT_NEAR(touch->closest.distance, distance_at(trial, face, touch->time), band(trial));
  if (touch->time > 0.0) {
    EXPECT_LE(touch->closest.distance,
              trial.radius + 1.01 * tolerance::kTouch + 1000.0 * oracle::rounding(trial));
    EXPECT_GE(touch->closest.distance, trial.radius - band(trial));
  } else {
    EXPECT_LE(touch->closest.distance, trial.radius);
  }
}

/// [m] The least distance during the leg, approximately.
double nearest_pass(const LinkTrial& trial, const FaceMotion& face) {
  double best = 0.0;
  const auto consider = [&](double time) {
    if (time < 0.0 || time > 1.0) return;
    if (distance_at(trial, face, time) < distance_at(trial, face, best)) best = time;
  };
  for (int i = 0; i <= 64; ++i) consider(i / 64.0);
  for (int halving = 6; halving < 30; ++halving) {
    const double step = std::ldexp(1.0, -halving);
    consider(best - step);
    consider(best + step);
  }
  return distance_at(trial, face, best);
}

class MovingCores : public oracle::LinkTrials {};
class SeparatedCores : public oracle::LinkTrials {};

// In some trials, the radius is slightly more or less than the least distance during the leg.
TEST_P(MovingCores, TouchFirstWhenASearchSays) {
  int touches = 0, count = 0;
  for_each_trial(75, [&](LinkTrial trial, Random& random) {
    const FaceMotion face = oracle::motion_to(trial.face, random);
    if (++count % 4 == 0) {
      const double nearest = nearest_pass(trial, face);
      const double grazing = nearest + random.sign() * random.scale(1e-10, 1e-4);
      if (nearest > 0.0 && grazing >= tolerance::kConvexMargin) trial.radius = grazing;
    }
    const RigidMotion motion = trial.motion();
    const auto touch = first_touch(CoreMotion(trial.core, motion), face, trial.radius);
    touches += touch.has_value();
    SCOPED_TRACE(testing::Message() << trial << " from" << oracle::text_of_all(face.start));
    expect_first(touch, trial, face);
  });
  EXPECT_GT(touches, 0);
}

TEST_P(MovingCores, DoNotTouchAfterTheEndOfTheSearch) {
  for_each_trial(100, [](const LinkTrial& trial, Random& random) {
    const FaceMotion face = oracle::motion_to(trial.face, random);
    const RigidMotion motion = trial.motion();
    const CoreMotion core(trial.core, motion);
    const auto touch = first_touch(core, face, trial.radius);
    const double until = random.uniform(0.0, 1.0);
    const auto early = first_touch(core, face, trial.radius, until);
    if (!touch || touch->time > until + 1e-4) {
      EXPECT_FALSE(early);
    } else if (touch->time < until - 1e-4) {
      ASSERT_TRUE(early);
      EXPECT_NEAR(early->time, touch->time, 1e-3);  // within kTouch of the radius
    }
    if (early) {
      EXPECT_LE(early->time, until);
    }
  });
}

// Every touching face is reported. An unresolved touch has a pair of points on core and face.
TEST_P(MovingCores, WithoutBudgetNoTouchIsMissed) {
  int unresolved = 0;
  for_each_trial(60, [&](const LinkTrial& trial, Random& random) {
    const FaceMotion face = oracle::motion_to(trial.face, random);
    const RigidMotion motion = trial.motion();
    const CoreMotion core(trial.core, motion);
    WorkBudget budget;
    budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs);
    const double until = random.chance(0.5) ? 1.0 : random.uniform(0.0, 1.0);
    const auto all = first_touch(core, face, trial.radius, until);
    const auto touch = first_touch(core, face, trial.radius, budget, until);
    if (all) {
      ASSERT_TRUE(touch);
    }
    if (!touch) return;
    EXPECT_LE(touch->time, all ? all->time : until);
    const ClosestPoints& closest = touch->closest;
    EXPECT_NEAR((closest.on_face - closest.on_core).norm(), closest.distance, band(trial));
    EXPECT_TRUE(closest.on_core.allFinite());
    EXPECT_NEAR(closest.barycentric.sum(), 1.0, 1e-9);
    if (touch->is_resolved) {
      EXPECT_TRUE(all);
    }
    unresolved += !touch->is_resolved;
  });
  EXPECT_GT(unresolved, 0);
}

// Planes that keep core and face apart: one at rest during the whole leg, and one that turns from
// one instant to another.
TEST_P(SeparatedCores, StayBeyondThePlanes) {
  int beyond = 0, clear = 0;
  for_each_trial(2000, [&](const LinkTrial& trial, Random& random) {
    const RigidMotion motion = trial.motion();
    const CoreMotion core(trial.core, motion);
    FaceMotion face{trial.face, trial.face};
    for (Vector3d& corner : face.end) corner += random.scale(1e-5, 0.1) * random.direction();
    const double begin = random.uniform(0.0, 0.5), end = begin + random.scale(1e-4, 0.5);
    const Instant from(begin, core, face), to(end, core, face);
    const double radius = random.uniform(0.0, 1.0) * from.closest.distance;
    if (from.closest.distance < 1e-6) return;
    const double share = clear_share(from, to, core, radius);
    EXPECT_GE(share, 0.0);
    clear += share > 0.0;
    const bool stays = FixedPlane(from.normal, core).keeps_beyond(face, radius);
    beyond += stays;
    const double until = stays ? 1.0 : begin + std::min(share, 1.0) * (end - begin);
    for (int step = 0; step < 20; ++step) {
      const double start = stays ? 0.0 : begin, time = start + step / 20.0 * (until - start);
      EXPECT_GT(closest_points(core.at(time), face.at(time)).distance,
                radius - 1e-12 - oracle::rounding(trial))
          << "at " << time << " of " << begin << " to " << end;
    }
  });
  EXPECT_GT(clear, 1000);
  EXPECT_GT(beyond, 20);
}

INSTANTIATE_TEST_SUITE_P(Kinds, MovingCores, oracle::LinkTrials::all());
// One kind of trials is enough.
INSTANTIATE_TEST_SUITE_P(Kinds, SeparatedCores,
                         testing::Combine(testing::Values(0),
                                          testing::Range<std::size_t>(0, oracle::kCoreKinds)));

}  // namespace
}  // namespace organ_collision
