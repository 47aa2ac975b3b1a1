// Forces from real queries, step by step along trajectories into creases and over edges.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "smooth_force.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

/// A shaft at these distances [m] from the two sides of a crease of 90 degrees.
ShaftAxis in_crease(double from_left, double from_right) {
  return lying(std::sqrt(0.5) * (from_left - from_right), std::sqrt(0.5) * (from_left + from_right),
               0.0);
}

}  // namespace

TEST(ForceTrajectory, BothSidesOfACreaseCountHoweverItIsDivided) {
  for (const double cell : {0.02, 0.01, 0.005, 0.0025, 0.00125, 0.0005}) {
    const auto steps =
        expect_no_jump("cell " + std::to_string(cell), folded_sheet(M_PI / 4, M_PI / 4, cell),
                       {in_crease(0.006, 0.007), in_crease(0.001, 0.0042)});
    const Vector3d left(std::sqrt(0.5), 0.0, std::sqrt(0.5)), right(-left.x(), 0.0, left.z());
    const Vector3d expected = kStiffness * (0.004 * left + 0.0008 * right);
    EXPECT_LE((steps.back().force - expected).norm(), 1e-3) << "cell " << cell;
  }
}

TEST(ForceTrajectory, PastOneSideOfACreaseTheOtherCountsOn) {
  for (const double cell : kCells) {
    const TriangleMesh crease = folded_sheet(M_PI / 4, M_PI / 4, cell);
    expect_no_jump("cell " + std::to_string(cell), crease,
                   {in_crease(0.006, 0.007), in_crease(0.001, 0.0042), in_crease(-0.002, 0.0035),
                    in_crease(-0.002, 0.0042), in_crease(0.006, 0.007)});
    for (const double tilt : {0.0, 0.01, -0.01}) {
      expect_no_jump("to its bottom, cell " + std::to_string(cell), crease,
                     {lying(0.0, 0.009, tilt), lying(0.0, -0.0035, tilt), lying(0.0, 0.009, tilt)});
    }
  }
}

TEST(ForceTrajectory, AnEdgeIsNotSlippedOffPastTheRadius) {
  for (const double cell : kCells) {
    const TriangleMesh edge = folded_sheet(-M_PI / 4, -M_PI / 4, cell);
    for (const double beside : {0.0, 3e-5, 1e-3}) {
      for (const double tilt : {0.0, -0.01, 0.05}) {
        const auto steps = expect_no_jump(
            "cell " + std::to_string(cell), edge,
            {lying(beside, 0.007, tilt), lying(beside, -0.004, tilt), lying(beside, 0.007, tilt)});
        // The force points straight away from the edge until the axis is half a radius from it.
        // From there on, its direction stays.
        const double half = std::sqrt(0.25 * kRadius * kRadius - beside * beside);
        for (const ForceStep& step : steps) {
          const double lowest = std::min(step.axis.tip.z(), step.axis.trocar.z());
          const Vector3d away(beside, 0.0, std::max(half, lowest));
          EXPECT_LE(angle_between(step.force, away), step.force.norm() > 0.5 ? 0.03 : 4.0);
        }
      }
    }
  }
}

TEST(ForceTrajectory, AcrossAnEdgeItPushesUp) {
  for (const double cell : kCells) {
    for (const double yaw : {0.0, 0.2}) {
      const auto at = [&](double z) {
        const Vector3d along(1.0, yaw, -0.013), middle(0.0, 0.003, z);
        return ShaftAxis{middle - 0.1 * along, middle + 0.06 * along};
      };
      const auto steps =
          expect_no_jump("cell " + std::to_string(cell), folded_sheet(-M_PI / 4, -M_PI / 4, cell),
                         {at(0.0061), at(-0.0045), at(0.0061)});
      for (const ForceStep& step : steps) {
        EXPECT_LE(angle_between(step.force, Vector3d::UnitZ()), step.force.norm() > 0.5 ? 0.1 : 4);
      }
    }
  }
}
