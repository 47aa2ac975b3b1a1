// On a flat sheet, the pull is the depth of the hand beyond the place where the proxy stops,
// however the sheet is tessellated and wherever the hand is.
#include <gtest/gtest.h>

#include "proxy_hands.hpp"
#include "test/closed_surfaces.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

constexpr double kNormal = 2e-7;  // [m] along the normal
/// [m] Within the plane, the proxy stops before an edge where less than this is left to go: a
/// twentieth of the clearance.
constexpr double kLateral = 5e-6;

void expect_pull(const ProxyAnswer& answer, double depth, const Vector3d& tip) {
  EXPECT_NEAR(answer.pull.z(), depth, kNormal) << "the hand is at " << tip.transpose();
  EXPECT_LE(answer.pull.head<2>().norm(), kLateral) << "the hand is at " << tip.transpose();
}

/// The flat sheet with its inner vertices moved within it by up to `share` of a cell, and some of
/// its squares cut along the other diagonal.
GridSurface irregular_sheet(int side, double share, Random& random) {
  GridSurface sheet = flat_sheet(side);
  const double cell = 0.2 / side;
  for (int row = 1; row < side; ++row) {
    for (int column = 1; column < side; ++column) {
      float* const at = &sheet.vertices[3 * static_cast<std::size_t>(row * (side + 1) + column)];
      for (int k = 0; k < 2; ++k) at[k] += static_cast<float>(random.uniform(-share, share) * cell);
    }
  }
  for (std::size_t i = 0; i < sheet.faces.size(); i += 2) {
    if (!random.chance(0.5)) continue;
    const auto [a, b, c] = sheet.faces[i];
    const std::uint32_t d = sheet.faces[i + 1][2];
    sheet.faces[i] = {a, b, d};
    sheet.faces[i + 1] = {b, c, d};
  }
  return shuffled(sheet, static_cast<unsigned>(random.integer(0, 1000)));
}

/// A place of a hand above the sheet: anywhere, above a vertex, or above an edge.
Vector3d place_on(const GridSurface& sheet, Random& random) {
  const int kind = random.integer(0, 2);
  if (kind == 0) return Vector3d(random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08), 0.0);
  const FaceIndices& face =
      sheet.faces[random.integer(0, static_cast<int>(sheet.faces.size()) - 1)];
  const auto corner = [&](int i) {
    const float* const at = &sheet.vertices[3 * face[i]];
    return Vector3d(at[0], at[1], at[2]);
  };
  const double share = kind == 1 ? 0.0 : random.uniform(0.0, 1.0);
  return 0.8 * ((1.0 - share) * corner(0) + share * corner(1));
}

void expect_depth(const ProxyTool& tool, const GridSurface& sheet, Random& random) {
  const ProxySettings settings;
  HapticProxy proxy(tool, settings);
  const std::vector<ProxyOrgan> organs = {organ_of(sheet)};
  Vector3d tip(0.0, 0.0, 0.02);
  proxy.follow(hand_of(tool, tip), organs);
  for (int i = 0; i < 8; ++i) {
    const double depth = random.scale(1e-5, 0.03);
    const Vector3d target =
        place_on(sheet, random) + (kToolRadius + settings.clearance - depth) * Vector3d::UnitZ();
    if (random.chance(0.3)) {
      move_hand(proxy, tool, tip, Vector3d(tip.x(), tip.y(), 0.02), 1.0, organs);
    }
    move_hand(proxy, tool, tip, target, random.scale(0.05, 1.0), organs);
    const ProxyAnswer* answer = nullptr;
    for (int tick = 0; tick < 20; ++tick) answer = &proxy.follow(hand_of(tool, tip), organs);
    EXPECT_EQ(answer->state, ProxyStatus::kTouching);
    expect_pull(*answer, depth, tip);
  }
}

class ProxyDepth : public testing::TestWithParam<ProxyFreedom> {
 protected:
  ProxyTool tool() const {
    return GetParam() == ProxyFreedom::kTrocar ? shaft_tool() : ball_tool();
  }
};

TEST_P(ProxyDepth, IsThePullOnGrids) {
  Random random(1);
  for (const int side : {1, 7, 50}) expect_depth(tool(), flat_sheet(side), random);
}

TEST_P(ProxyDepth, IsThePullOnIrregularTriangles) {
  Random random(2);
  for (const int side : {3, 20}) {
    for (const double share : {0.2, 0.45}) {
      expect_depth(tool(), irregular_sheet(side, share, random), random);
    }
  }
}

TEST_P(ProxyDepth, IsThePullOnUnweldedTriangles) {
  Random random(3);
  expect_depth(tool(), unwelded(irregular_sheet(8, 0.4, random)), random);
}

TEST_P(ProxyDepth, IsTheHandsWhileItSlides) {
  Random random(4);
  const ProxyTool its_tool = tool();
  const ProxySettings settings;
  HapticProxy proxy(its_tool, settings);
  const std::vector<ProxyOrgan> organs = {organ_of(irregular_sheet(20, 0.4, random))};
  const double stop = kToolRadius + settings.clearance;
  Vector3d tip(-0.05, 0.0, 0.02);
  proxy.follow(hand_of(its_tool, tip), organs);
  move_hand(proxy, its_tool, tip, Vector3d(-0.05, 0.0, stop - 5e-3), 0.5, organs);
  for (const double speed : {0.02, 0.1, 0.3}) {
    const Vector3d to(-tip.x(), random.uniform(-0.05, 0.05), tip.z());
    move_hand(proxy, its_tool, tip, to, speed, organs,
              [&](const Vector3d& hand, const ProxyAnswer& answer) {
                expect_pull(answer, stop - hand.z(), hand);
              });
  }
}

INSTANTIATE_TEST_SUITE_P(Tools, ProxyDepth,
                         testing::Values(ProxyFreedom::kTrocar, ProxyFreedom::kFree));

}  // namespace
}  // namespace organ_collision
