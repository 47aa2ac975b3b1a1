// What contacts of real queries push with, step by step along trajectories: over flat tissue, a
// wall, creases, edges, a saddle and through a sheet, coarse and fine.

#include "force_trajectory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "penalty_wrench.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kStep = 1e-4;  // [m]
constexpr double kCells[] = {0.02, 0.005, 0.00125};

/// A law that begins anew.
ForceLaw remembering_law(const KeptSides::Radius& radius = kRadius) {
  return [radius, sides = KeptSides()](const ContactArray& answer) mutable {
    const auto force = penalty_wrench(sides.follow(answer, radius), kStiffness).force;
    return Vector3d(force.x, force.y, force.z);
  };
}

std::vector<ForceStep> expect_no_jump(const std::string& what, const TriangleMesh& organ,
                                      const std::vector<ShaftAxis>& corners) {
  const auto steps = forces_along(way_through(corners, kStep), organ, remembering_law());
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_LE(steps[i].change, 5.0 * kStiffness * steps[i].way)
        << what << ", step " << i << ", tip at " << steps[i].axis.tip.transpose() << ": force "
        << steps[i].force.transpose() << " after " << steps[i - 1].force.transpose();
  }
  return steps;
}

/// Along the y axis, through (x, 0.003, z), its tip lower by `tilt` [rad].
ShaftAxis lying(double x, double z, double tilt) {
  const Vector3d middle(x, 0.003, z), along(0.0, 1.0, -tilt);
  return {middle - 0.05 * along, middle + 0.04 * along};
}

/// At these distances from the two sides of a crease of 90 degrees.
ShaftAxis in_crease(double from_left, double from_right) {
  return lying(std::sqrt(0.5) * (from_left - from_right), std::sqrt(0.5) * (from_left + from_right),
               0.0);
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A block: its top is the plane z = 0 where x > 0, its wall the plane x = 0 below.
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
        // How deep the trocar's end is once it has sunk, no contact says.
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
        for (const ForceStep& step : steps) {
          if (step.force.norm() > 0.5) {
            EXPECT_LE(angle_between(step.force, Vector3d::UnitZ()), 0.6);
          }
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

TEST(ForceTrajectory, OnASaddle) {
  for (const double cell : {0.005, 0.0025, 0.00125}) {
    const int cells = static_cast<int>(std::lround(0.06 / cell));
    const TriangleMesh saddle = grid_mesh(cells, cells, [](double u, double v) -> Vector3d {
      const double x = 0.06 * u - 0.0297, y = 0.06 * v - 0.0302;
      return {x, y, (x * x - y * y) / 0.06};
    });
    for (const double yaw : {0.0, 0.7}) {
      const auto at = [&](double z) {
        const Vector3d along(std::sin(yaw), std::cos(yaw), -0.02), middle(0.0, 0.001, z);
        return ShaftAxis{middle - 0.05 * along, middle + 0.02 * along};
      };
      expect_no_jump("cell " + std::to_string(cell), saddle, {at(0.015), at(-0.001), at(0.015)});
    }
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

TEST(ForceTrajectory, OfAnUnknownRadiusItStaysPastTheFace) {
  const TriangleMesh sheet = folded_sheet(0.0, 0.0, 0.005);
  const auto at = [](double z) { return lying(0.0013, z, 0.0); };
  const auto steps = forces_along(way_through({at(0.006), at(-0.0045), at(0.006)}, kStep), sheet,
                                  remembering_law(std::nullopt));
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_LE(steps[i].change, 2.0 * kStiffness * kStep);
    const double depth = std::clamp(kRadius - steps[i].axis.tip.z(), 0.0, kRadius);
    EXPECT_NEAR(steps[i].force.z(), kStiffness * depth, kStiffness * 2 * kStep);
  }
}
