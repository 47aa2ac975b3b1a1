#include "test/proof/step_oracle.hpp"

#include <gtest/gtest.h>

#include "test/proof/clearance_trials.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision::oracle {
namespace {

/// Some trials of each kind, at rest and moving.
std::vector<ToolStep> make_steps() {
  std::vector<ToolStep> steps;
  for (std::size_t kind = 0; kind < trial_kinds().size(); ++kind) {
    Random random(kind);
    for (int i = 0; i < 10; ++i) {
      steps.push_back(make_resting_shaft(kind, random).step);
      steps.push_back(make_moving_shaft(kind, random).step);
    }
  }
  for (std::size_t kind = 0; kind < link_trial_kinds().size(); ++kind) {
    Random random(kind);
    for (std::size_t part = 0; part < link_part_kinds().size(); ++part) {
      steps.push_back(make_resting_link(kind, part, random).step);
      steps.push_back(make_moving_link(kind, part, random).step);
    }
  }
  return steps;
}

TEST(StepOracle, rounds_what_it_decides_exactly) {
  Random random(1);
  for (const ToolStep& step : make_steps()) {
    const double fraction = random.chance(0.2) ? 1.0 : random.uniform(0.0, 1.0);
    const double distance = rounded_distance(step, fraction);
    EXPECT_TRUE(is_within(step, fraction, distance + 2e-9)) << step;
    EXPECT_FALSE(is_within(step, fraction, distance - 2e-9) &&
                 distance + surface_radius(step) > 3e-9)
        << step;
  }
}

/// The search agrees with many distances on the way, and its bound is sharp.
TEST(StepOracle, finds_the_closest_approach) {
  for (const ToolStep& step : make_steps()) {
    double sampled = rounded_distance(step, 1.0);
    for (int i = 0; i < 200; ++i) sampled = std::min(sampled, rounded_distance(step, i / 200.0));
    double closest = 0.0;
    EXPECT_FALSE(stays_above(step, sampled + 1e-6, closest)) << step;
    double low = -surface_radius(step) - 1e-6, high = sampled + 1e-6;
    while (high - low > 1e-5) {
      const double middle = 0.5 * (low + high);
      (stays_above(step, middle, closest) ? low : high) = middle;
    }
    EXPECT_FALSE(stays_above(step, high, closest)) << step;
    EXPECT_LE(closest, high + 1e-8) << step;
  }
}

}  // namespace
}  // namespace organ_collision::oracle
