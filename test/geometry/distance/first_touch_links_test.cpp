// first_touch.hpp for the cores of links, which rotate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "geometry/distance/first_touch.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "test/proof/first_touch_oracle.hpp"
#include "test/proof/link_trials.hpp"

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
