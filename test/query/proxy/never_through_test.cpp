#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proxy_scenes.hpp"
#include "test/closed_surfaces.hpp"
#include "test/proof/proxy/episode.hpp"
#include "test/proof/proxy/referee.hpp"
#include "test/proof/proxy/scenes.hpp"
#include "test/proof/proxy/scripted_motion.hpp"

// Short runs of proxy_proof: the proxy never passes through tissue, never comes too near, and is
// never overrun.

namespace organ_collision {
namespace {

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
                           for (char& c : name) c = c == ' ' ? '_' : c;
                           return name;
                         });

}  // namespace

}  // namespace organ_collision

// On a flat sheet, the pull is the depth of the hand beyond the place where the proxy stops,
// however the sheet is tessellated and wherever the hand is.

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

// The pull is continuous while the proxy slides over edges that it does not slip off.
//
// Around a convex edge, the proxy's tip moves on an arc whose radius R is the tool's radius plus
// the clearance. If the pull is p < R long, the hand moves on an arc of radius R - p. So the pull
// changes by at most p / (R - p) of the hand's way, and by at most the hand's way where the surface
// is flat or concave. The way of a surface that moves counts like the hand's. A hand that is
// farther beyond an edge than R makes the proxy slip off it.

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const double kStop = kToolRadius + ProxySettings().clearance;  // [m] R above
constexpr double kFloor = 5e-6;                                // [m] a twentieth of the clearance

/// Follows the pull from tick to tick.
class Continuity {
 public:
  void begin() { was_touching_ = false; }

  void operator()(const Vector3d& hand, const ProxyAnswer& answer) { add(hand, 0.0, answer); }

  /// `surface_way` [m]: how far the surface moved in the tick, at most.
  void add(const Vector3d& hand, double surface_way, const ProxyAnswer& answer) {
    const bool touches = answer.state == ProxyStatus::kTouching;
    if (was_touching_ && touches) check(hand, surface_way, answer.pull);
    was_touching_ = touches;
    pull_ = answer.pull;
    hand_ = hand;
  }

  long ticks() const { return ticks_; }

 private:
  void check(const Vector3d& hand, double surface_way, const Vector3d& pull) {
    ++ticks_;
    const double most = std::max(pull.norm(), pull_.norm());
    ASSERT_LT(most, 0.9 * kStop) << "the test is for hands that do not slip off";
    const double factor = std::max(1.0, most / (kStop - most));
    EXPECT_LE((pull - pull_).norm(), factor * ((hand - hand_).norm() + surface_way) + kFloor)
        << "the hand is at " << hand.transpose();
  }

  bool was_touching_ = false;
  Vector3d pull_ = Vector3d::Zero(), hand_ = Vector3d::Zero();
  long ticks_ = 0;
};

/// The hand's tip goes along `curve`, from -1 to 1, at several speeds. It comes from above.
template <typename Curve>
void expect_continuity(const ProxyTool& tool, const GridSurface& surface, const Curve& curve) {
  HapticProxy proxy(tool, {});
  const std::vector<ProxyOrgan> organs = {organ_of(surface)};
  Continuity continuity;
  Vector3d tip = curve(-1.0) + Vector3d(0.0, 0.0, 0.04);
  proxy.follow(hand_of(tool, tip), organs);
  for (const double speed : {0.15, 0.5}) {
    move_hand(proxy, tool, tip, curve(-1.0) + Vector3d(0.0, 0.0, 0.04), 0.5, organs);
    move_hand(proxy, tool, tip, curve(-1.0), 0.2, organs);
    continuity.begin();
    constexpr int kPieces = 100;
    for (int i = -kPieces; i <= kPieces; ++i) {
      move_hand(proxy, tool, tip, curve(static_cast<double>(i) / kPieces), speed, organs,
                std::ref(continuity));
    }
  }
  EXPECT_GT(continuity.ticks(), 100);
}

class ProxySliding : public testing::TestWithParam<ProxyFreedom> {
 protected:
  ProxyTool tool() const {
    return GetParam() == ProxyFreedom::kTrocar ? shaft_tool() : ball_tool();
  }
};

TEST_P(ProxySliding, GoesOverTheEdgesOfASphere) {
  const GridSurface ball = sphere(20, 40, 0.05);
  for (const double depth : {0.3e-3, 1.5e-3, 2.4e-3}) {
    const double radius = 0.05 + kStop - depth;
    expect_continuity(tool(), ball, [&](double t) {
      return Vector3d(radius * std::sin(0.8 * t), 0.1 * radius * t, radius * std::cos(0.8 * t));
    });
  }
}

TEST_P(ProxySliding, GoesThroughAConcaveCrease) {
  for (const double slope : {0.3, 1.0}) {
    const auto height = [&](double x, double) { return slope * std::abs(x - 3e-3); };
    for (const double depth : {0.5e-3, 1.2e-3}) {
      expect_continuity(tool(), height_field(31, height), [&](double t) {
        return Vector3d(0.04 * t, 0.02 * t, height(0.04 * t, 0.0) + kStop - depth);
      });
    }
  }
}

TEST_P(ProxySliding, GoesOverAConvexCrease) {
  for (const double slope : {0.3, 1.0}) {
    const auto height = [&](double x, double) { return -slope * std::abs(x); };
    for (const double depth : {0.5e-3, 1.5e-3}) {
      expect_continuity(tool(), height_field(30, height), [&](double t) {
        return Vector3d(0.04 * t, 0.02 * t, height(0.04 * t, 0.0) + kStop - depth);
      });
    }
  }
}

TEST_P(ProxySliding, GoesOverASaddle) {
  const auto height = [](double x, double y) { return 5.0 * (x * x - y * y); };
  for (const double depth : {0.5e-3, 1.5e-3, 2.2e-3}) {
    expect_continuity(tool(), height_field(40, height), [&](double t) {
      const double x = 0.04 * t, y = 0.03 * std::sin(3.0 * t);
      return Vector3d(x, y, height(x, y) + kStop - depth);
    });
  }
}

TEST_P(ProxySliding, FollowsASurfaceThatMoves) {
  oracle::OrganMotion motion;
  motion.sway = Vector3d(2e-3, 3e-3, 0.2e-3);
  motion.sway_rate = 20.0;
  motion.turn = Vector3d(0.0, 0.0, 0.05);
  motion.turn_rate = 9.0;
  for (const bool moves_frame : {false, true}) {
    motion.moves_frame = moves_frame;
    oracle::ScriptedOrgan organ("organ", sphere(20, 40, 0.05), motion);
    const double speed = motion.sway.norm() * motion.sway_rate + 0.05 * 0.05 * motion.turn_rate;
    HapticProxy proxy(tool(), {});
    Continuity continuity;
    for (int tick = 0; tick < 2000; ++tick) {
      // Down to the sphere within 100 ticks, and then slowly along it.
      const Vector3d along(0.3 * std::sin(4e-3 * tick), 0.2, 1.0);
      const double above = std::max(-1.2e-3, 3e-3 - 5e-5 * tick);
      const Vector3d tip = (0.05 + kStop + above) * along.normalized();
      continuity.add(tip, 1e-3 * speed, proxy.follow(hand_of(tool(), tip), {organ.at(tick)}));
    }
    EXPECT_GT(continuity.ticks(), 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Tools, ProxySliding,
                         testing::Values(ProxyFreedom::kTrocar, ProxyFreedom::kFree));

}  // namespace

}  // namespace organ_collision

// Where tissue closes in from both sides, the proxy says SQUEEZED, stays between, and recovers.

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const double kStop = kToolRadius + ProxySettings().clearance;  // [m]

/// Two sheets around z = 0, which are this far apart [m].
GridSurface plates(double gap) {
  return joined(flat_sheet(6, 0.5 * gap), turned_over(flat_sheet(9, -0.5 * gap)));
}

/// The distance between two plates that close and open again, at 5 mm/s [m].
double gap_at(int tick) {
  return std::max(4e-3, 0.012 - 5e-6 * tick) + std::max(0.0, 5e-6 * (tick - 2400));
}

TEST(ProxySqueeze, StaysBetweenTwoPlatesThatClose) {
  const ProxyTool tool = ball_tool();
  const ProxySettings settings;
  HapticProxy proxy(tool, settings);
  ProxyOrgan organ = organ_of(plates(gap_at(0)));
  oracle::Referee referee(tool, settings, [](const std::string& what) { ADD_FAILURE() << what; });
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
