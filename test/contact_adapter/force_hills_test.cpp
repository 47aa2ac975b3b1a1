// Forces from real queries, step by step along trajectories over saddles and hills.

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "contact_adapter/penalty_forces.hpp"
#include "smooth_force.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

/// A saddle with the curvatures 1 / radius along the x axis, where it rises, and -1 / radius along
/// the y axis.
TriangleMesh saddle(double radius, double cell) {
  const int cells = static_cast<int>(std::lround(0.06 / cell));
  return grid_mesh(cells, cells, [&](double u, double v) -> Vector3d {
    const double x = 0.06 * u - 0.0297, y = 0.06 * v - 0.0302;
    return {x, y, (x * x - y * y) / (2.0 * radius)};
  });
}

}  // namespace

TEST(ForceTrajectory, OnASaddle) {
  // In some of these cases the tip is in the rising wall of the valley, or the axis is past the
  // saddle.
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
  // At a height of 1.7 mm, the tip moves to another facet, and its depth changes by 1.3 mm.
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
  ForceLaw law;
  const auto steps = forces_along(poses, organ, [&](const ContactArray& answer) {
    const Vector3d now =
        to_eigen(wrench_of(law.follow(answer, kSeconds, kStiffness, kRadius)).force);
    Vector3d goal = Vector3d::Zero();
    for (const Vector3d& force : penalty_forces(sides.follow(answer, kRadius), kStiffness)) {
      goal += force;
    }
    lags.push_back((now - goal).norm());
    return now;
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
