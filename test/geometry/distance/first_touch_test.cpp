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

TEST(WorkBudget, IsUsedUpByItsLastStep) {
  WorkBudget budget;
  budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs - 1);
  EXPECT_FALSE(budget.is_used_up());
  budget.spend(1);
  EXPECT_TRUE(budget.is_used_up());
}

TEST(WorkBudget, GrowsWithThePairsBeyondTheLeast) {
  WorkBudget budget;
  budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs);
  budget.add_pairs(WorkBudget::kLeastPairs);
  EXPECT_TRUE(budget.is_used_up());
  budget.add_pairs(1);
  EXPECT_FALSE(budget.is_used_up());
  budget.spend(WorkBudget::kStepsForEachPair);
  EXPECT_TRUE(budget.is_used_up());
}

TEST(WorkBudget, GrowsNoFurtherThanTheMostPairs) {
  WorkBudget budget;
  budget.add_pairs(1000 * WorkBudget::kMostPairs);
  budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kMostPairs - 1);
  EXPECT_FALSE(budget.is_used_up());
  budget.spend(1);
  EXPECT_TRUE(budget.is_used_up());
}

TEST(WorkBudget, UnlimitedIsNeverUsedUp) {
  WorkBudget budget = WorkBudget::unlimited();
  budget.spend(std::uint64_t{1} << 60U);
  EXPECT_FALSE(budget.is_used_up());
}

TEST(WorkBudget, ApproachesGetMoreForEachPairButNotMoreInAll) {
  WorkBudget budget = WorkBudget::for_approaches();
  budget.spend(WorkBudget::kApproachStepsForEachPair * WorkBudget::kLeastPairs - 1);
  EXPECT_FALSE(budget.is_used_up());
  budget.spend(1);
  EXPECT_TRUE(budget.is_used_up());

  WorkBudget large = WorkBudget::for_approaches();
  large.add_pairs(1000 * WorkBudget::kMostPairs);
  large.spend(WorkBudget::kStepsForEachPair * WorkBudget::kMostPairs);
  EXPECT_TRUE(large.is_used_up());
}

TEST(WorkBudget, CutsAreNotForgottenIfMorePairsCome) {
  WorkBudget budget;
  budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs);
  EXPECT_EQ(budget.cuts(), 0U);
  budget.add_cut();
  budget.add_pairs(2 * WorkBudget::kLeastPairs);
  EXPECT_FALSE(budget.is_used_up());
  EXPECT_EQ(budget.cuts(), 1U);
}

using Eigen::Vector3d;
using oracle::Random;
using oracle::Trial;

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
    const auto earliest = oracle::first_time_within(trial.motion, face, trial.radius, slack);
    touches += touch.has_value();
    if (earliest.certainly) {
      EXPECT_TRUE(touch);
    }
    if (!earliest.possibly) {
      EXPECT_FALSE(touch);
    }
    if (touch) {
      expect_at_radius(*touch, trial.motion, face, trial.radius);
      EXPECT_GE(touch->time, earliest.possibly.value_or(2.0) - 1e-12);
      if (earliest.certainly) {
        EXPECT_LE(touch->time, *earliest.certainly + 1e-12);
      }
    }
    if (HasFailure()) ADD_FAILURE() << oracle::to_line(trial);
  }
  EXPECT_GT(touches, 0);
}

TEST_P(FirstTouchTrials, WithoutMotionIsTheDistance) {
  Random random(400 + GetParam());
  for (int i = 0; i < 300; ++i) {
    const Trial trial = oracle::make_trial(GetParam(), random);
    const ShaftAxis& axis = trial.motion.end;
    const auto touch = first_touch(ShaftMotion{axis, axis}, resting(trial.face), trial.radius);
    EXPECT_EQ(touch.has_value(), closest_points(axis, trial.face).distance <= trial.radius);
    if (touch) {
      EXPECT_EQ(touch->time, 0.0);
    }
  }
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

// The tip passes a corner at a least distance slightly more or less than the radius.
TEST(FirstTouch, GrazingIsDecidedByTheRadius) {
  const Vector3d corner(0.05, 0.02, -0.1);
  const Triangle face = {corner, corner + Vector3d(0.01, 0.003, 0.02),
                         corner + Vector3d(0.01, -0.004, 0.015)};
  for (const double radius : {0.5e-3, 5e-3}) {
    for (int digits = 3; digits <= 12; ++digits) {
      for (const double sign : {-1.0, 1.0}) {
        const double gap = radius * (1.0 + sign * std::pow(10.0, -digits));
        const Vector3d middle = corner - gap * Vector3d(1.0, 0.0, 0.0);
        const Vector3d half(0.0, 0.03, 0.07);
        const ShaftAxis start{middle - half - Vector3d(0.2, 0.0, 0.0), middle - half};
        const ShaftAxis end{start.trocar + 2.0 * half, middle + half};
        const auto touch = first_touch(ShaftMotion{start, end}, resting(face), radius);
        if (std::abs(gap - radius) > kBand) {
          EXPECT_EQ(touch.has_value(), gap < radius) << radius << " " << sign * digits;
        }
        if (touch) {
          EXPECT_NEAR(touch->time, 0.5, 0.01 + std::sqrt(std::pow(10.0, -digits)));
        }
      }
    }
  }
}

TEST(FirstTouch, TissueThatSwingsThroughARestingToolIsFound) {
  const ShaftAxis axis{{0.3, 0.1, 0.5}, {0.1, 0.1, 0.02}};
  const Triangle before = {Vector3d(-0.4, 0.05, 0.1), Vector3d(-0.42, 0.3, 0.11),
                           Vector3d(-0.41, 0.1, 0.35)};
  const Vector3d swing(0.9, 0.0, 0.0);
  const FaceMotion motion{before, {before[0] + swing, before[1] + swing, before[2] + swing}};
  EXPECT_FALSE(first_touch(ShaftMotion{axis, axis}, resting(motion.start), 2e-3));
  EXPECT_FALSE(first_touch(ShaftMotion{axis, axis}, resting(motion.end), 2e-3));
  const auto touch = first_touch(ShaftMotion{axis, axis}, motion, 2e-3);
  ASSERT_TRUE(touch);
  expect_at_radius(*touch, {axis, axis}, motion, 2e-3);
  EXPECT_LT(touch->closest.on_face.x(), touch->closest.on_core.x());
}

// The ball touches when its distance from the plane is the radius.
TEST(FirstTouch, TimeOfABallThatFallsOnAFace) {
  const Triangle face = {Vector3d(-1.0, -1.0, 0.2), Vector3d(2.0, -1.0, 0.2),
                         Vector3d(-1.0, 2.0, 0.2)};
  const Vector3d high(0.03, 0.01, 0.7), low(0.05, -0.02, 0.1);
  const auto touch = first_touch(ShaftMotion{{high, high}, {low, low}}, resting(face), 0.025);
  ASSERT_TRUE(touch);
  EXPECT_NEAR(touch->time, 0.475 / 0.6, 1e-9);
}

}  // namespace

}  // namespace organ_collision

// first_touch.hpp for the cores of links, which rotate.

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

FaceMotion resting(const Triangle& face) { return {face, face}; }

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

/// Checks that the touch is not missed, is neither too early nor too late, and is at the radius.
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

WorkBudget used_up() {
  WorkBudget budget;
  budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs);
  return budget;
}

// Every touching face is reported. An unresolved touch has a pair of points on core and face.
TEST_P(FirstTouchOfLinks, WithoutBudgetNoTouchIsMissed) {
  int unresolved = 0;
  for_each_trial(60, [&](const LinkTrial& trial, const FaceMotion& face, Random& random) {
    const RigidMotion motion = trial.motion();
    const CoreMotion core(trial.core, motion);
    WorkBudget budget = used_up();
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

// A plate turns about its middle until its end touches a face 0.1 m below.
TEST(FirstTouch, TimeOfAPlateThatTurnsOntoAFace) {
  const Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d end = start;
  end.linear() = Eigen::AngleAxisd(0.8, Vector3d::UnitY()).toRotationMatrix();
  const ConvexCore plate = LinkPart::box(start, {0.4, 0.1, 1e-6}).core;
  const Triangle face = {Vector3d(-1.0, -1.0, -0.1), Vector3d(2.0, -1.0, -0.1),
                         Vector3d(-1.0, 2.0, -0.1)};
  const RigidMotion motion(start, end);
  const auto touch = first_touch(CoreMotion(plate, motion), resting(face), 0.01);
  ASSERT_TRUE(touch);
  const double angle = touch->time * 0.8;
  EXPECT_NEAR(0.2 * std::sin(angle) + 0.5e-6 * std::cos(angle), 0.1 - 0.01, 2e-10);
  EXPECT_NEAR(touch->closest.on_core.x(), 0.2 * std::cos(angle), 1e-6);
}

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
