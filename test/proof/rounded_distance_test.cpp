#include "test/proof/rounded_distance.hpp"

#include <gtest/gtest.h>

#include "test/proof/exact_distance.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision::oracle {
namespace {

TEST(RoundedDistance, agrees_with_exact_arithmetic) {
  for (std::size_t kind = 0; kind < trial_kinds().size(); ++kind) {
    Random random(kind);
    for (int i = 0; i < 1000; ++i) {
      const Trial trial = make_trial(kind, random);
      for (const Triangle& tool : {core(trial.motion), core(trial.motion.end)}) {
        EXPECT_NEAR(rounded_distance(tool, trial.face), distance(tool, trial.face), 1e-11)
            << trial_kinds()[kind] << ' ' << to_line(trial);
        EXPECT_NEAR(rounded_distance(trial.face, tool), distance(tool, trial.face), 1e-11)
            << trial_kinds()[kind] << ' ' << to_line(trial);
      }
    }
  }
}

}  // namespace
}  // namespace organ_collision::oracle
