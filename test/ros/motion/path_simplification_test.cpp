#include "ros/motion/path_simplification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

const PathDeviation kOfAShaft({});
const Vector3d kTrocar(0.1, 0.2, 0.5);

/// A path whose waypoints are evenly spaced in time, with these heights of the tip.
ToolPath heights(const std::vector<double>& heights) {
  ToolPath path;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double fraction = double(i) / double(heights.size() - 1);
    path.push_back({fraction, {kTrocar, {0.3, 0.1, heights[i]}}});
  }
  return path;
}

/// [m] The distance of the waypoint from the path at the same time.
double distance(const ToolPath& path, const ToolWaypoint& waypoint) {
  std::size_t leg = 1;
  while (path[leg].fraction < waypoint.fraction) ++leg;
  return kOfAShaft(waypoint, StraightMotion(path[leg - 1], path[leg])).most();
}

std::vector<double> fractions(const ToolPath& path) {
  std::vector<double> fractions;
  for (const ToolWaypoint& waypoint : path) fractions.push_back(waypoint.fraction);
  return fractions;
}

}  // namespace

TEST(SimplifiedPath, WhatFitsStays) {
  const ToolPath path = heights({0.0, 0.3, 0.1, 0.2, 0.5});
  for (const std::size_t legs : {4u, 5u, 100u}) {
    const SimplifiedPath simplified = simplify_path(path, kOfAShaft, legs);
    EXPECT_EQ(fractions(simplified.path), fractions(path));
    EXPECT_EQ(simplified.dropped, 0u);
    EXPECT_EQ(simplified.deviation, 0.0);
  }
  EXPECT_EQ(simplify_path(resting_path({{kTrocar, kTrocar}}), kOfAShaft, 1).path.size(), 1u);
}

TEST(SimplifiedPath, WhatMattersMostStays) {
  const ToolPath path = heights({0.0, 0.001, -0.002, 0.4, 0.0, 0.02, 0.0, 0.001, 0.0});
  SimplifiedPath simplified = simplify_path(path, kOfAShaft, 2);
  EXPECT_EQ(fractions(simplified.path), (std::vector<double>{0.0, 0.375, 1.0}));
  EXPECT_EQ(simplified.dropped, 6u);
  simplified = simplify_path(path, kOfAShaft, 4);
  EXPECT_EQ(simplified.path.size(), 5u);
  EXPECT_EQ(simplified.path[2].axis.tip.z(), 0.4);
  EXPECT_LT(simplified.deviation, 0.021);
  simplified = simplify_path(path, kOfAShaft, 1);
  EXPECT_EQ(fractions(simplified.path), (std::vector<double>{0.0, 1.0}));
  EXPECT_NEAR(simplified.deviation, 0.4, 1e-12);
}

TEST(SimplifiedPath, OnAStraightMotionNothingMatters) {
  const SimplifiedPath simplified =
      simplify_path(heights({0.0, 0.25, 0.5, 0.75, 1.0}), kOfAShaft, 3);
  EXPECT_EQ(simplified.deviation, 0.0);
  EXPECT_EQ(simplified.path.size() + simplified.dropped, 5u);
}

TEST(SimplifiedPath, NothingIsFartherFromTheWayThanItSays) {
  std::mt19937 random(11);
  std::normal_distribution<double> number(0.0, 0.05);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> tips = {0.0};
    while (tips.size() < 60) tips.push_back(tips.back() + number(random));
    const ToolPath path = heights(tips);
    for (const std::size_t legs : {1u, 3u, 10u, 40u}) {
      const SimplifiedPath simplified = simplify_path(path, kOfAShaft, legs);
      ASSERT_EQ(simplified.path.size(), legs + 1);
      EXPECT_EQ(simplified.dropped, path.size() - simplified.path.size());
      double farthest = 0.0;
      for (const ToolWaypoint& waypoint : path) {
        farthest = std::max(farthest, distance(simplified.path, waypoint));
      }
      EXPECT_NEAR(simplified.deviation, farthest, 1e-12);
    }
  }
}
