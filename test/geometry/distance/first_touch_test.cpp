#include "geometry/distance/first_touch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "geometry/distance/work_budget.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/step_oracle.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;
using oracle::Trial;

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
  constexpr std::uint64_t kForApproaches = WorkBudget::kApproachStepsForEachPair;
  expect_steps(WorkBudget::for_approaches(), 0, kForApproaches * kLeast);
  expect_steps(WorkBudget::for_approaches(), 1000 * kMost, kSteps * kMost);
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

// The core is pierced by an edge of the face, from (0.2, 0.2, 0) on. The common segment ends where
// the core does.
TEST(TriangleCrossing, IsInTheMiddleOfTheCommonSegment) {
  const Triangle core = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const Triangle face = {Vector3d(0.2, 0.2, -1), Vector3d(0.2, 0.2, 1), Vector3d(2.2, 0.2, 0)};
  const auto crossing = triangle_crossing(core, face);
  ASSERT_TRUE(crossing);
  EXPECT_TRUE(crossing->on_face.isApprox(Vector3d(0.5, 0.2, 0.0), 1e-15));
  EXPECT_TRUE(crossing->barycentric.isApprox(Vector3d(0.425, 0.425, 0.15), 1e-15));
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

/// [m] A face whose distance is within this of the radius may touch or not. The distance of every
/// touch is within this of the radius.
constexpr double kBand = 1e-9;

FaceMotion resting(const Triangle& face) { return {face, face}; }

/// Checks that the touch is at the radius, unless it is at the start, and that its fields belong to
/// its time.
void expect_at_radius(const FirstTouch& touch, const ShaftMotion& shaft, const FaceMotion& face,
                      double radius) {
  EXPECT_GE(touch.time, 0.0);
  EXPECT_LE(touch.time, 1.0);
  if (touch.time > 0.0) {
    EXPECT_NEAR(touch.closest.distance, radius, kBand);
  } else {
    EXPECT_LE(touch.closest.distance, radius);
  }
  EXPECT_NEAR(touch.closest.distance,
              oracle::distance(oracle::core(shaft.at(touch.time)), face.at(touch.time)), 1e-12);
}

/// Checks that a touch is not missed, and is neither too early nor too late.
void expect_timely(const std::optional<FirstTouch>& touch, const oracle::FirstTime& earliest) {
  if (earliest.certainly) {
    EXPECT_TRUE(touch);
  }
  if (!earliest.possibly) {
    EXPECT_FALSE(touch);
  }
  if (!touch) return;
  EXPECT_GE(touch->time, earliest.possibly.value_or(2.0) - 1e-12);
  EXPECT_LE(touch->time, earliest.certainly.value_or(1.0) + 1e-12);
}

/// Checks a trial with a resting face and trocar: there is a touch if and only if exact arithmetic
/// finds one, and none is earlier.
void expect_exact(const Trial& trial) {
  const auto touch = first_touch(trial.motion, resting(trial.face), trial.radius);
  const Triangle swept = oracle::core(trial.motion);
  if (oracle::within(swept, trial.face, trial.radius - kBand)) {
    EXPECT_TRUE(touch);
  }
  if (!oracle::within(swept, trial.face, trial.radius + kBand)) {
    EXPECT_FALSE(touch);
  }
  if (touch) {
    expect_at_radius(*touch, trial.motion, resting(trial.face), trial.radius);
    const ShaftMotion until{trial.motion.start, trial.motion.at(touch->time)};
    if (touch->time > 0.0) {
      EXPECT_FALSE(oracle::within(oracle::core(until), trial.face, trial.radius - kBand));
    }
  }
  if (testing::Test::HasFailure()) ADD_FAILURE() << oracle::to_line(trial);
}

class FirstTouchTrials : public testing::TestWithParam<std::size_t> {};

TEST_P(FirstTouchTrials, AgreesWithExactArithmetic) {
  Random random(200 + GetParam());
  for (int i = 0; i < 500 && !HasFailure(); ++i)
    expect_exact(oracle::make_trial(GetParam(), random));
}

TEST_P(FirstTouchTrials, AgreesWithSearchWhereEverythingMoves) {
  Random random(300 + GetParam());
  int touches = 0;
  for (int i = 0; i < 30 && !HasFailure(); ++i) {
    Trial trial = oracle::make_trial(GetParam(), random);
    trial.motion.start.trocar += random.scale(1e-4, 0.05) * random.direction();
    FaceMotion face = resting(trial.face);
    for (Vector3d& corner : face.start) corner += random.scale(1e-4, 0.05) * random.direction();
    face.start = oracle::rounded(face.start);
    const auto touch = first_touch(trial.motion, face, trial.radius);
    const double slack = std::max(1e-6, 1e-4 * trial.radius);
    touches += touch.has_value();
    expect_timely(touch, oracle::first_time_within(trial.motion, face, trial.radius, slack));
    if (touch) expect_at_radius(*touch, trial.motion, face, trial.radius);
    if (HasFailure()) ADD_FAILURE() << oracle::to_line(trial);
  }
  EXPECT_GT(touches, 0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, FirstTouchTrials,
                         testing::Range<std::size_t>(0, oracle::trial_kinds().size()));

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
    first_touch(ShaftMotion{start, {start.trocar + step, start.tip + step}}, resting(face), radius,
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

TEST(FirstTouch, TrialsThatOnceFailed) {
  for (const Trial& trial :
       oracle::read_trials(ORGAN_COLLISION_TEST_DATA "/first_touch_trials.txt"))
    expect_exact(trial);
}

// For the cores of links, which rotate.

/// [m] A face whose distance is within this of the radius may touch or not. It includes the
/// rounding errors of planes along large faces and of distances far from the origin.
double band(const LinkTrial& trial) {
  const double size =
      (trial.face[1] - trial.face[0]).norm() + (trial.face[2] - trial.face[0]).norm();
  return 1e-9 * (1.0 + size) + 1000.0 * oracle::rounding(trial);
}

FaceMotion some_motion(const Triangle& face, Random& random) {
  FaceMotion motion{face, face};
  if (random.chance(0.5)) return motion;
  for (Vector3d& corner : motion.start) corner += random.scale(1e-5, 0.05) * random.direction();
  return motion;
}

/// Checks that the touch is timely and at the radius.
void expect_first(const std::optional<FirstTouch>& touch, const LinkTrial& trial,
                  const FaceMotion& face) {
  expect_timely(touch, oracle::first_time_within(trial, face, band(trial)));
  if (!touch) return;
  const double distance =
      closest_points(oracle::pose_at(trial, touch->time) * trial.core, face.at(touch->time))
          .distance;
  EXPECT_NEAR(touch->closest.distance, distance, band(trial));
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
  const auto distance_at = [&](double time) {
    return closest_points(oracle::pose_at(trial, time) * trial.core, face.at(time)).distance;
  };
  double best = 0.0;
  for (int i = 0; i <= 64; ++i) {
    if (distance_at(i / 64.0) < distance_at(best)) best = i / 64.0;
  }
  for (int halving = 6; halving < 30; ++halving) {
    const double step = std::ldexp(1.0, -halving);
    for (const double time : {best - step, best + step}) {
      if (time >= 0.0 && time <= 1.0 && distance_at(time) < distance_at(best)) best = time;
    }
  }
  return distance_at(best);
}

/// For each kind of trials and each kind of core.
class FirstTouchOfLinks : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {
 protected:
  template <typename Check>
  void for_each_trial(int count, Check check) {
    const auto [kind, core_kind] = GetParam();
    Random random(700 + 10 * kind + core_kind);
    for (int i = 0; i < count && !HasFailure(); ++i) {
      LinkTrial trial = oracle::make_link_trial(kind, core_kind, random);
      const FaceMotion face = some_motion(trial.face, random);
      check(trial, face, random);
      if (HasFailure()) {
        ADD_FAILURE() << trial << " from " << face.start[0].transpose() << ", "
                      << face.start[1].transpose() << ", " << face.start[2].transpose();
      }
    }
  }
};

TEST_P(FirstTouchOfLinks, AgreesWithSearch) {
  int touches = 0;
  for_each_trial(60, [&](const LinkTrial& trial, const FaceMotion& face, Random& /*random*/) {
    const RigidMotion motion = trial.motion();
    const auto touch = first_touch(CoreMotion(trial.core, motion), face, trial.radius);
    touches += touch.has_value();
    expect_first(touch, trial, face);
  });
  EXPECT_GT(touches, 0);
}

// The radius is slightly more or less than the least distance during the leg.
TEST_P(FirstTouchOfLinks, GrazingIsDecidedByTheRadius) {
  for_each_trial(25, [](LinkTrial trial, const FaceMotion& face, Random& random) {
    const double nearest = nearest_pass(trial, face);
    trial.radius = nearest + random.sign() * random.scale(1e-10, 1e-4);
    if (nearest == 0.0 || trial.radius < tolerance::kConvexMargin) return;
    const RigidMotion motion = trial.motion();
    expect_first(first_touch(CoreMotion(trial.core, motion), face, trial.radius), trial, face);
  });
}

TEST_P(FirstTouchOfLinks, UntilCutsTheLegShort) {
  for_each_trial(100, [](const LinkTrial& trial, const FaceMotion& face, Random& random) {
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
TEST_P(FirstTouchOfLinks, WithoutBudgetNoTouchIsMissed) {
  int unresolved = 0;
  for_each_trial(60, [&](const LinkTrial& trial, const FaceMotion& face, Random& random) {
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

INSTANTIATE_TEST_SUITE_P(
    Kinds, FirstTouchOfLinks,
    testing::Combine(testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()),
                     testing::Range<std::size_t>(0, oracle::kCoreKinds)));

// The blade is clear of the face at both ends of the leg and sweeps through it in between.
TEST(FirstTouch, ABladeThatSwingsPastIsFound) {
  const Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d end = start;
  end.linear() = Eigen::AngleAxisd(3.0, Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Isometry3d shape = Eigen::Isometry3d::Identity();
  shape.translation().x() = 0.2;
  const Triangle face = {Vector3d(0.0, 0.2, -0.01), Vector3d(0.0, 0.2, 0.01),
                         Vector3d(0.001, 0.21, 0.0)};
  const RigidMotion motion(start, end);
  for (const ConvexCore& blade :
       {LinkPart::box(shape, {0.1, 0.001, 0.1}).core, LinkPart::cylinder(shape, 0.001, 0.1).core}) {
    const auto touch =
        first_touch(CoreMotion(blade, motion), resting(face), tolerance::kConvexMargin);
    ASSERT_TRUE(touch);
    EXPECT_NEAR(touch->time, 0.5 * M_PI / 3.0, 0.01);
    const RigidMotion short_of(start, motion.at(0.5));
    EXPECT_FALSE(first_touch(CoreMotion(blade, short_of), resting(face), tolerance::kConvexMargin));
  }
}

}  // namespace
}  // namespace organ_collision
