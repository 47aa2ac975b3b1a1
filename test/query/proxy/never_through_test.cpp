// Short runs of proxy_proof: the proxy never passes through tissue, never comes too near, and is
// never overrun. Where tissue closes in from both sides, it says SQUEEZED, stays between, and
// recovers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "proxy_scenes.hpp"
#include "test/proof/proxy/episode.hpp"
#include "test/proof/proxy/referee.hpp"
#include "test/proof/proxy/scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

class NeverThrough : public testing::TestWithParam<std::string> {};

TEST_P(NeverThrough, WhateverTheHandDoes) {
  const oracle::ProxyTally tally = oracle::follow_hand(
      {GetParam(), 7, 0}, 2000,
      [](long tick, const std::string& what) { ADD_FAILURE() << "tick " << tick << ": " << what; });
  EXPECT_EQ(tally.broken(), 0);
  EXPECT_EQ(tally.ticks, 2000);
}

INSTANTIATE_TEST_SUITE_P(Scenes, NeverThrough, testing::ValuesIn(oracle::proxy_scene_kinds()),
                         [](const auto& kind) {
                           std::string name = kind.param;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

/// The distance between two plates or jaws that close and open again, at 5 mm/s [m].
double gap_at(int tick) {
  return std::max(4e-3, 0.012 - 5e-6 * tick) + std::max(0.0, 5e-6 * (tick - 2400));
}

TEST(ProxySqueeze, StaysBetweenTwoPlatesThatClose) {
  const auto plates = [](double gap) {
    return joined(flat_sheet(6, 0.5 * gap), turned_over(flat_sheet(9, -0.5 * gap)));
  };
  const ProxyTool tool = ball_tool();
  HapticProxy proxy(tool, {});
  ProxyOrgan organ = organ_of(plates(gap_at(0)));
  oracle::Referee referee(tool, {}, [](const std::string& what) { ADD_FAILURE() << what; });
  // The hand is not in the middle, and goes into the upper plate.
  const ToolPose hand = ball_hand({0.01, 0.003, 0.002});
  long squeezed = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    const auto shape = std::make_shared<TriangleMesh>(*organ.shape);
    shape->move_vertices(plates(gap_at(tick)).vertices);
    organ.shape = shape;
    const ProxyAnswer& answer = proxy.follow(hand, {organ});
    referee.check(hand, false, {organ}, {false}, answer);
    const double half = 0.5 * gap_at(tick), z = answer.proxy.axis.tip.z();
    if (half < kToolRadius) {
      EXPECT_EQ(answer.state, ProxyStatus::kSqueezed) << half;
      EXPECT_NEAR(z, 0.0, 1e-4) << half;
      ++squeezed;
    } else if (half > kStop) {
      EXPECT_NE(answer.state, ProxyStatus::kSqueezed) << half;
      EXPECT_NEAR(z, std::min(0.002, half - kStop), 1e-5) << half;
    }
  }
  EXPECT_GT(squeezed, 500);
}

/// A closed box, 60 mm wide and 5 mm thick. Its middle is 1 mm above the origin.
GridSurface slab() {
  GridSurface box = grid_cube(4, 0.015F);
  for (std::size_t i = 0; i < box.vertices.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> at(&box.vertices[i]);
    at = (at.array() - 0.03F) * Eigen::Array3f(1.0F, 1.0F, 5.0F / 60.0F);
    at.z() += 1e-3F;
  }
  return box;
}

TEST(ProxySqueeze, HoldsTissueBetweenJawsThatClose) {
  // Two boxes along x, whose inner faces are `gap` apart.
  const LinkPart box = LinkPart::box(Eigen::Isometry3d::Identity(), {0.02, 4e-3, 2e-3});
  const ProxyTool tool{0.0, {{"upper", {box}}, {"lower", {box}}}, ProxyFreedom::kFree};
  const auto hand = [](double gap) {
    ToolPose pose{{Vector3d::Zero(), Vector3d::Zero()}};
    for (const double side : {1.0, -1.0}) {
      pose.links.emplace_back(Eigen::Translation3d(0.0, 0.0, side * (0.5 * gap + 1e-3)));
    }
    return pose;
  };
  const std::vector<ProxyOrgan> organs = {organ_of(slab())};
  HapticProxy proxy(tool, {});
  oracle::Referee referee(tool, {}, [](const std::string& what) { ADD_FAILURE() << what; });
  long squeezed = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const double gap = gap_at(tick);
    const ProxyAnswer& answer = proxy.follow(hand(gap), organs);
    referee.check(hand(gap), false, organs, {true}, answer);
    if (answer.state == ProxyStatus::kSqueezed) ++squeezed;
    if (gap < 5e-3) {
      EXPECT_EQ(answer.state, ProxyStatus::kSqueezed) << gap;
    } else if (gap > 5.2e-3) {
      EXPECT_NE(answer.state, ProxyStatus::kSqueezed) << gap;
    }
  }
  EXPECT_GT(squeezed, 500);
}

}  // namespace
}  // namespace organ_collision
