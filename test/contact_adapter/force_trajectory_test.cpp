// The forces from contacts of real queries, step by step along trajectories: over flat tissue, a
// wall, creases, edges, saddles and hills, and through a sheet, with coarse and with fine meshes.

#include "force_trajectory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "contact_adapter/penalty_wrench.hpp"
#include "contact_adapter/wrench_law.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kStep = 1e-4;     // [m]
constexpr double kSeconds = 1e-3;  // [s] duration of a step
constexpr double kCells[] = {0.02, 0.005, 0.00125};

/// A new WrenchLaw.
ForceLaw remembering_law(const KeptSides::Radius& radius = kRadius) {
  return [radius, law = WrenchLaw()](const ContactArray& answer) mutable {
    const auto force = law.follow(answer, kSeconds, kStiffness, radius).force;
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

/// A shaft along the y axis through (x, 0.003, z), with the tip tilted down by `tilt` [rad].
ShaftAxis lying(double x, double z, double tilt) {
  const Vector3d middle(x, 0.003, z), along(0.0, 1.0, -tilt);
  return {middle - 0.05 * along, middle + 0.04 * along};
}

/// A shaft at these distances from the two sides of a crease of 90 degrees.
ShaftAxis in_crease(double from_left, double from_right) {
  return lying(std::sqrt(0.5) * (from_left - from_right), std::sqrt(0.5) * (from_left + from_right),
               0.0);
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A block: its top is the plane z = 0 for x > 0, and its wall the plane x = 0 below.
TriangleMesh block(double cell) {
  const int across = static_cast<int>(std::lround(0.08 / cell));
  return grid_mesh(across, 2 * across, [](double u, double v) -> Vector3d {
    const double way = 0.08 * u - 0.04;
    return {std::max(way, 0.0), 0.16 * v - 0.0813, std::min(way, 0.0)};
  });
}

/// A saddle with the curvature 1 / radius along the x axis, where it rises, and -1 / radius along
/// y.
TriangleMesh saddle(double radius, double cell) {
  const int cells = static_cast<int>(std::lround(0.06 / cell));
  return grid_mesh(cells, cells, [&](double u, double v) -> Vector3d {
    const double x = 0.06 * u - 0.0297, y = 0.06 * v - 0.0302;
    return {x, y, (x * x - y * y) / (2.0 * radius)};
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
        // No contact tells how deep the end at the trocar is after it has sunk in.
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
        // The force points straight away from the edge, and turns no further below half the radius.
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

TEST(ForceTrajectory, OnASaddle) {
  // Some poses have the tip in the rising wall of the valley, or the axis past the saddle.
  for (const double radius : {0.03, 0.012}) {
    for (const double cell : {0.02, 0.005, 0.0025, 0.00125}) {
      const TriangleMesh organ = saddle(radius, cell);
      for (const double yaw : {0.0, 0.7, 1.2, 1.5}) {
        const auto at = [&](double z) {
          const Vector3d along(std::sin(yaw), std::cos(yaw), -0.02), middle(0.0, 0.001, z);
          return ShaftAxis{middle - 0.05 * along, middle + 0.02 * along};
        };
        expect_no_jump("radius " + std::to_string(radius) + ", cell " + std::to_string(cell) +
                           ", yaw " + std::to_string(yaw),
                       organ, {at(0.015), at(-0.003), at(0.015)});
      }
    }
  }
}

TEST(ForceTrajectory, AtRestItComesToThePushes) {
  // At a height of 1.7 mm the tip comes over another facet, and the depth changes by 1.3 mm.
  const TriangleMesh organ = saddle(0.03, 0.005);
  const auto at = [](double z) {
    const Vector3d along(std::sin(1.5), std::cos(1.5), -0.02), middle(0.0, 0.001, z);
    return ShaftAxis{middle - 0.05 * along, middle + 0.02 * along};
  };
  std::vector<ShaftAxis> poses = way_through({at(0.015), at(0.0017)}, kStep);
  const std::size_t stop = poses.size() - 1;
  poses.insert(poses.end(), 30, poses.back());
  KeptSides sides;
  std::vector<double> lags;
  WrenchLaw law;
  const auto steps = forces_along(poses, organ, [&](const ContactArray& answer) {
    const auto now = law.follow(answer, kSeconds, kStiffness, kRadius).force;
    const auto goal = penalty_wrench(sides.follow(answer, kRadius), kStiffness).force;
    lags.push_back(Vector3d(now.x - goal.x, now.y - goal.y, now.z - goal.z).norm());
    return Vector3d(now.x, now.y, now.z);
  });
  EXPECT_GT(lags[stop], 0.5);
  EXPECT_LE(lags.back(), 1e-9);
  for (std::size_t i = stop + 3; i < steps.size(); ++i) EXPECT_LE(steps[i].change, 0.0501);
}

TEST(ForceTrajectory, OverHillsOnRandomWays) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 60; ++i) {
    const double height = 0.004 * (1.0 + number(random)), shift = number(random);
    const TriangleMesh hills = grid_mesh(12, 12, [&](double u, double v) -> Vector3d {
      const double x = 0.06 * u - 0.0297, y = 0.06 * v - 0.0302;
      return {x, y, height * std::sin(200.0 * x + shift) * std::cos(170.0 * y)};
    });
    const double yaw = 3.0 * number(random);
    const Vector3d along(std::sin(yaw), std::cos(yaw), 0.1 * number(random));
    Vector3d middle(0.005 * number(random), 0.005 * number(random), 0.022);
    std::vector<ShaftAxis> corners;
    for (const double highest : {0.022, 0.004, 0.004, 0.004, 0.022}) {
      const double lean = 0.003 * number(random);
      corners.push_back({middle - 0.05 * along + Vector3d(lean, 0.0, 0.01), middle + 0.02 * along});
      middle = {middle.x() + 0.004 * number(random), middle.y() + 0.004 * number(random),
                highest - 0.003 * (1.0 + number(random))};
    }
    expect_no_jump("way " + std::to_string(i), hills, corners);
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
