#include "geometry/distance/first_touch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/first_touch_oracle.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

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
