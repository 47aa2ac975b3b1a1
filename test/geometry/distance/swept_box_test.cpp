#include "geometry/distance/swept_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "geometry/distance/closest_points.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

constexpr std::size_t kBox = 2;  // the number of this kind of core

/// The box with the core of a trial.
OrientedBox box_of(const ConvexCore& core) {
  const auto& p = core.points;
  OrientedBox box{0.5 * (p[0] + p[7]), {}, {}};
  const std::array<Vector3d, 3> edges = {p[4] - p[0], p[2] - p[0], p[1] - p[0]};
  for (int i = 0; i < 3; ++i) {
    box.half_size[i] = 0.5 * edges[i].norm();
    box.axes.col(i) = edges[i].normalized();
  }
  return box;
}

class SweptBoxTrials : public testing::TestWithParam<std::size_t> {
 protected:
  template <typename Check>
  void for_each_trial(int count, Check check) {
    Random random(50 + GetParam());
    for (int i = 0; i < count && !HasFailure(); ++i) {
      const LinkTrial trial = oracle::make_link_trial(GetParam(), kBox, random);
      check(trial, random);
      if (HasFailure()) ADD_FAILURE() << trial;
    }
  }
};

TEST_P(SweptBoxTrials, HoldsTheGrownBoxAllTheTime) {
  for_each_trial(300, [](const LinkTrial& trial, Random& random) {
    const RigidMotion motion = trial.motion();
    const SweptBox swept(box_of(trial.core), motion, trial.radius);
    EXPECT_LE((swept.axes() * swept.axes().transpose() - Eigen::Matrix3d::Identity()).norm(),
              1e-12);
    EXPECT_GT(swept.axes().determinant(), 0.0);
    EXPECT_LE((swept.origin() - motion.start() * box_of(trial.core).center).norm(),
              oracle::rounding(trial));
    for (int i = 0; i < 50; ++i) {
      const double time = i < 2 ? i : random.uniform(0.0, 1.0);
      const ConvexCore core = motion.at(time) * trial.core;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d along = swept.axes().col(axis);
        const double slack = oracle::rounding(trial);
        EXPECT_LE(core.support_value(along) + trial.radius, swept.high()[axis] + slack);
        EXPECT_GE(-core.support_value(-along) - trial.radius, swept.low()[axis] - slack);
      }
    }
  });
}

// If the link does not turn, the box reaches its bounds.
TEST_P(SweptBoxTrials, IsTightWithoutTurning) {
  for_each_trial(300, [](LinkTrial trial, Random& /*random*/) {
    trial.end.linear() = trial.start.linear();
    const SweptBox swept(box_of(trial.core), trial.motion(), trial.radius);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d along = swept.axes().col(axis);
      const double high = std::max((trial.start * trial.core).support_value(along),
                                   (trial.end * trial.core).support_value(along));
      EXPECT_NEAR(swept.high()[axis], high + trial.radius, 2.0 * oracle::rounding(trial));
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, SweptBoxTrials,
                         testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()));

}  // namespace
}  // namespace organ_collision
