#include "demo/scripted_tools.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "demo/liver.hpp"
#include "geometry/distance/closest_points.hpp"

namespace organ_collision {
namespace {

constexpr double kPeriod = 0.008;  // [s] of a step of the simulator

/// [m] The distance from the axis to the liver at rest.
double distance_to_liver(const ShaftAxis& axis) {
  static const ClosedSurface liver = make_liver_surface();
  double nearest = 1.0;
  for (std::size_t face = 0; face < liver.faces.size(); ++face) {
    nearest = std::min(nearest, closest_points(axis, liver.triangle(face)).distance);
  }
  return nearest;
}

TEST(ScriptedTools, PalpatorIsSlowAndPressesAndLifts) {
  EXPECT_GT(liver_level(kPalpator.trocar), 0.03);
  int pressing = 0, lifted = 0;
  double deepest = 0.0;
  for (double time = 0.0; time < 30.0; time += 0.1) {
    const double speed = (kPalpator.tip(time + kPeriod) - kPalpator.tip(time)).norm() / kPeriod;
    EXPECT_LT(speed, 0.06) << "[m/s] at " << time << " s";
    const double distance = distance_to_liver(kPalpator.at(time));
    (distance < kToolRadius ? pressing : lifted) += 1;
    deepest = std::min(deepest, liver_level(kPalpator.tip(time)));
  }
  // The hand presses deeper than the tissue yields, so one sees it apart from its proxy.
  EXPECT_LT(deepest, -0.010);
  EXPECT_GT(pressing, 100);
  EXPECT_GT(lifted, 50);
}

TEST(ScriptedTools, StabberPassesThroughTheLobeWithinOneStepAndRestsOutside) {
  static_assert(kStabDuration <= kPeriod);
  EXPECT_GT(liver_level(kStabber.trocar), 0.03);
  constexpr double kBreath = 0.007;  // [m] motion of the liver by breathing
  for (int second = 0; second < 14; ++second) {
    for (double time = second + kPeriod; time < second + 1.0001; time += 0.031) {
      EXPECT_GT(distance_to_liver(kStabber.at(time)), kToolRadius + kBreath)
          << "at " << time << " s a static test would find it";
    }
    const double halfway = second + 1.0 + 0.5 * kStabDuration;
    EXPECT_LT(distance_to_liver(kStabber.at(halfway)), 1e-9) << "at " << halfway << " s";
    EXPECT_LT(liver_level(kStabber.tip(halfway)), 0.0) << "its tip is inside the lobe";
  }
  for (int step = 1; step < 125 * 6; ++step) {
    const double moved = (kStabber.tip((step + 1) / 125.0) - kStabber.tip(step / 125.0)).norm();
    if (step % 125 == 0) {
      EXPECT_NEAR(moved, 0.108, 0.001) << step;
    } else {
      EXPECT_LT(moved, 0.001) << step;
    }
  }
}

}  // namespace
}  // namespace organ_collision
