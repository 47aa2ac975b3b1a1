#include "demo/scripted_tools.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "demo/liver.hpp"
#include "geometry/distance/closest_points.hpp"

namespace organ_collision {
namespace {

constexpr double kPeriod = 0.008;  // [s] of a step of the simulator

const ScriptedTool& tool(const std::string& name) {
  const auto& tools = scripted_tools();
  return *std::find_if(tools.begin(), tools.end(),
                       [&](const ScriptedTool& tool) { return tool.name == name; });
}

/// [m] The distance from the axis to the liver at rest.
double distance_to_liver(const ShaftAxis& axis) {
  static const ClosedSurface liver = make_liver_surface();
  double nearest = 1.0;
  for (std::size_t face = 0; face < liver.faces.size(); ++face) {
    nearest = std::min(nearest, closest_points(axis, liver.triangle(face)).distance);
  }
  return nearest;
}

TEST(ScriptedTools, AreAPalpatorAndAStabber) {
  ASSERT_EQ(scripted_tools().size(), 2U);
  EXPECT_EQ(scripted_tools()[0].name, "palpator");
  EXPECT_EQ(scripted_tools()[1].name, "stabber");
}

TEST(ScriptedTools, OnlyThePalpatorIsHeldByAHand) {
  EXPECT_TRUE(tool("palpator").has_proxy);
  EXPECT_FALSE(tool("stabber").has_proxy);
}

TEST(ScriptedTools, PassThroughFixedTrocarsOutsideOfTheLiver) {
  for (const ScriptedTool& tool : scripted_tools()) {
    for (double time = 0.0; time < 20.0; time += 0.1) {
      EXPECT_EQ(tool.at(time).trocar, tool.trocar);
      EXPECT_GT((tool.at(time).tip - tool.trocar).norm(), 0.08);
      EXPECT_LT((tool.at(time).tip - tool.trocar).norm(), 0.30);
    }
    EXPECT_GT(liver_level(tool.trocar), 0.03);
  }
}

TEST(ScriptedTools, PalpatorIsSlowAndPressesAndLifts) {
  const ScriptedTool& palpator = tool("palpator");
  int pressing = 0, lifted = 0;
  double deepest = 0.0;
  for (double time = 0.0; time < 30.0; time += 0.1) {
    const double speed = (palpator.tip(time + kPeriod) - palpator.tip(time)).norm() / kPeriod;
    EXPECT_LT(speed, 0.06) << "[m/s] at " << time << " s";
    const double distance = distance_to_liver(palpator.at(time));
    (distance < kToolRadius ? pressing : lifted) += 1;
    deepest = std::min(deepest, liver_level(palpator.tip(time)));
  }
  // The hand presses deeper than the tissue yields, so one sees it apart from its proxy.
  EXPECT_LT(deepest, -0.010);
  EXPECT_GT(pressing, 100);
  EXPECT_GT(lifted, 50);
}

TEST(ScriptedTools, StabberPassesThroughTheLobeWithinOneStepAndRestsOutside) {
  const ScriptedTool& stabber = tool("stabber");
  constexpr double kBreath = 0.007;  // [m] motion of the liver by breathing
  for (int second = 0; second < 14; ++second) {
    for (double time = second + kPeriod; time < second + 1.0001; time += 0.031) {
      EXPECT_GT(distance_to_liver(stabber.at(time)), kToolRadius + kBreath)
          << "at " << time << " s a static test would find it";
    }
    const double halfway = second + 1.0 + 0.5 * kStabDuration;
    EXPECT_LT(distance_to_liver(stabber.at(halfway)), 1e-9) << "at " << halfway << " s";
    EXPECT_LT(liver_level(stabber.tip(halfway)), 0.0) << "its tip is inside the lobe";
  }
}

TEST(ScriptedTools, StabFitsBetweenTwoStepsOfTheSimulator) {
  static_assert(kStabDuration <= kPeriod);
  const auto& tip = tool("stabber").tip;
  for (int step = 0; step < 125 * 6; ++step) {
    const double moved = (tip((step + 1) / 125.0) - tip(step / 125.0)).norm();
    if (step > 0 && step % 125 == 0) {
      EXPECT_NEAR(moved, 0.108, 0.001) << "step " << step;
    } else {
      EXPECT_LT(moved, 0.001) << "step " << step;
    }
  }
}

}  // namespace
}  // namespace organ_collision
