#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <tuple>

#include "geometry/organ/organ_motion.hpp"
#include "link_trials.hpp"

namespace organ_collision::oracle {

/// Tests with random trials of one kind and one kind of core.
class LinkTrials : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {
 public:
  /// All kinds of trials with all kinds of cores.
  static auto all() {
    return testing::Combine(testing::Range<std::size_t>(0, link_trial_kinds().size()),
                            testing::Range<std::size_t>(0, kCoreKinds));
  }

 protected:
  /// Calls `check(trial, random)`. A trial that fails is printed, and is the last one.
  template <typename Check>
  void for_each_trial(int count, Check check) {
    const auto [kind, core_kind] = GetParam();
    Random random(700 + 10 * kind + core_kind);
    for (int i = 0; i < count && !HasFailure(); ++i) {
      const LinkTrial trial = make_link_trial(kind, core_kind, random);
      check(trial, random);
      if (HasFailure()) ADD_FAILURE() << trial;
    }
  }
};

/// A face that rests, or whose corners come from up to 0.05 m away.
inline FaceMotion motion_to(const Triangle& face, Random& random) {
  FaceMotion motion{face, face};
  if (random.chance(0.5)) return motion;
  for (Eigen::Vector3d& corner : motion.start) {
    corner += random.scale(1e-5, 0.05) * random.direction();
  }
  return motion;
}

}  // namespace organ_collision::oracle
