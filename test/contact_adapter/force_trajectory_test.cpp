// Forces from real queries, step by step along trajectories against flat surfaces: tissue, a wall,
// a sheet.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "smooth_force.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

/// A block with its top in the plane z = 0 (where x > 0) and its wall in the plane x = 0 below it.
TriangleMesh block(double cell) {
  const int across = static_cast<int>(std::lround(0.08 / cell));
  return grid_mesh(across, 2 * across, [](double u, double v) -> Vector3d {
    const double way = 0.08 * u - 0.04;
    return {std::max(way, 0.0), 0.16 * v - 0.0813, std::min(way, 0.0)};
  });
}

}  // namespace

TEST(ForceTrajectory, LyingOnTissueItGrowsOnPastTheRadius) {
  for (const double cell : kCells) {
    const TriangleMesh sheet = folded_sheet(0.0, 0.0, cell);
    for (const double tilt : {0.0, 0.01, -0.01, 0.05}) {
      const auto at = [&](double z) { return lying(0.0013, z, tilt); };
      const auto steps = expect_no_jump("cell " + std::to_string(cell), sheet,
                                        {at(0.007), at(-0.0045), at(0.007)});
      for (const ForceStep& step : steps) {
        const double lowest = std::min(step.axis.tip.z(), step.axis.trocar.z());
        const double depth = std::max(0.0, kRadius - lowest);
        EXPECT_LE(angle_between(step.force, Vector3d::UnitZ()), step.force.z() > 0.1 ? 1e-3 : 4.0);
        // If the trocar's end is inside the tissue, no contact reports its depth.
        if (tilt < 0.0 && step.axis.trocar.z() < 0.0) continue;
        EXPECT_NEAR(step.force.z(), kStiffness * depth, 2.0 * kStiffness * kStep);
      }
    }
  }
}

TEST(ForceTrajectory, SlidingWhileSunkItStays) {
  for (const double cell : kCells) {
    const TriangleMesh sheet = folded_sheet(0.0, 0.0, cell);
    const auto steps = expect_no_jump(
        "cell " + std::to_string(cell), sheet,
        {lying(0.0013, 0.006, 0.0), lying(0.0013, -0.003, 0.0), lying(0.0113, -0.003, 0.0)});
    EXPECT_NEAR(steps.back().force.z(), kStiffness * (kRadius + 0.003), kStiffness * 2 * kStep);
    EXPECT_LE(angle_between(steps.back().force, Vector3d::UnitZ()), 1e-3);
  }
}

TEST(ForceTrajectory, PushedIntoAWallItStaysTheWalls) {
  for (const double cell : kCells) {
    const TriangleMesh organ = block(cell);
    for (const double lean : {0.0, 0.001, -0.001, 0.01}) {
      const auto at = [&](double x) {
        return ShaftAxis{{x - lean, 0.0031, 0.1}, {x, 0.0031, -0.013}};
      };
      const auto steps = expect_no_jump("cell " + std::to_string(cell), organ,
                                        {at(-0.0061), at(0.0045), at(-0.0061)});
      for (const ForceStep& step : steps) {
        EXPECT_LE(step.force.x(), 1e-9);
        EXPECT_LE(step.force.z(), 0.15 * std::abs(step.force.x()) + 1e-9);
      }
    }
  }
}

TEST(ForceTrajectory, TurnedIntoAWallAboutTheTrocarItStaysTheWalls) {
  const auto at = [](double x) { return ShaftAxis{{-0.0061, 0.0031, 0.1}, {x, 0.0031, -0.013}}; };
  for (const double cell : kCells) {
    const auto steps = expect_no_jump("cell " + std::to_string(cell), block(cell),
                                      {at(-0.0061), at(0.0045), at(-0.0061)});
    for (const ForceStep& step : steps) EXPECT_LE(step.force.x(), 1e-9);
  }
}

TEST(ForceTrajectory, ThroughASheetAndBack) {
  for (const double cell : kCells) {
    for (const double lean : {0.0, 0.3, 1.0}) {
      const Vector3d along = Vector3d(lean, 0.1 * lean, -1.0).normalized();
      const Vector3d hole(0.0013, 0.0021, 0.0);
      const auto at = [&](double way) { return ShaftAxis{hole - 0.1 * along, hole + way * along}; };
      const auto steps =
          expect_no_jump("cell " + std::to_string(cell), folded_sheet(0.0, 0.0, cell),
                         {at(-0.015), at(0.03), at(-0.015)});
      for (const ForceStep& step : steps) {
        const double depth = std::max(0.0, kRadius - step.axis.tip.z());
        EXPECT_LE((step.force - kStiffness * depth * Vector3d::UnitZ()).norm(), kStiffness * kStep);
      }
    }
  }
}

TEST(ForceTrajectory, OfAnUnknownRadiusItGrowsOnPastTheFaceToo) {
  const TriangleMesh sheet = folded_sheet(0.0, 0.0, 0.005);
  const auto at = [](double z) { return lying(0.0013, z, 0.0); };
  const auto steps = forces_along(way_through({at(0.006), at(-0.0045), at(0.006)}, kStep), sheet,
                                  remembering_law(std::nullopt));
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_LE(steps[i].change, 2.0 * kStiffness * kStep);
    const double depth = std::max(0.0, kRadius - steps[i].axis.tip.z());
    EXPECT_NEAR(steps[i].force.z(), kStiffness * depth, kStiffness * 2 * kStep);
  }
}
