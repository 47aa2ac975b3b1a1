// haptic_proxy.hpp: the pull on the hand. On a flat sheet it is the depth of the hand; it is
// continuous where the proxy slides; the loads of the contacts balance it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "proxy_scenes.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/proxy/scripted_motion.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

// Depth: however the sheet is tessellated and wherever the hand is.

/// Within the plane, the proxy stops before an edge where less than a twentieth of the clearance is
/// left to go.
void expect_depth(const ProxyAnswer& answer, double depth, const Vector3d& tip) {
  EXPECT_NEAR(answer.pull.z(), depth, 2e-7) << "the hand is at " << tip.transpose();
  EXPECT_LE(answer.pull.head<2>().norm(), 5e-6) << "the hand is at " << tip.transpose();
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

class ProxyDepth : public ProxyWith {};

TEST_P(ProxyDepth, IsThePull) {
  Random random(1);
  for (const GridSurface& sheet :
       {flat_sheet(1), flat_sheet(7), flat_sheet(50), irregular_sheet(3, 0.45, random),
        irregular_sheet(20, 0.45, random), unwelded(irregular_sheet(8, 0.4, random))}) {
    HapticProxy proxy(tool_, {});
    const std::vector<ProxyOrgan> organs = {organ_of(sheet)};
    Vector3d tip(0.0, 0.0, 0.02);
    proxy.follow(hand_of(tool_, tip), organs);
    for (int i = 0; i < 8; ++i) {
      const double depth = random.scale(1e-5, 0.03);
      const Vector3d target = place_on(sheet, random) + (kStop - depth) * Vector3d::UnitZ();
      if (random.chance(0.3)) {
        move_hand(proxy, tool_, tip, Vector3d(tip.x(), tip.y(), 0.02), 1.0, organs);
      }
      move_hand(proxy, tool_, tip, target, random.scale(0.05, 1.0), organs);
      const ProxyAnswer* answer = nullptr;
      for (int tick = 0; tick < 20; ++tick) answer = &proxy.follow(hand_of(tool_, tip), organs);
      EXPECT_EQ(answer->state, ProxyStatus::kTouching);
      expect_depth(*answer, depth, tip);
    }
  }
}

TEST(ProxyDepthOfAShaft, IsThePullWhileTheTrocarMoves) {
  const ProxyTool tool = shaft_tool();
  HapticProxy proxy(tool, {});
  const std::vector<ProxyOrgan> organs = {organ_of(flat_sheet(20))};
  Vector3d tip(0.0, 0.0, 0.03);
  move_hand(proxy, tool, tip, Vector3d(0.0, 0.0, -0.01), 0.2, organs);
  for (int tick = 0; tick < 1000; ++tick) {
    const double angle = 2e-3 * M_PI * tick;
    ToolPose hand = shaft_hand(tip);
    hand.axis.trocar += 0.02 * Vector3d(std::sin(angle), 1.0 - std::cos(angle), 0.0);
    const ProxyAnswer& answer = proxy.follow(hand, organs);
    ASSERT_EQ(answer.state, ProxyStatus::kTouching);
    EXPECT_NEAR(answer.pull.z(), 0.01 + kStop, 1e-6);
    EXPECT_LE(answer.pull.head<2>().norm(), 5e-6);
  }
}

// Continuity: around a convex edge, the proxy's tip moves on an arc whose radius R is the tool's
// radius plus the clearance. If the pull is p < R long, the hand moves on an arc of radius R - p.
// So the pull changes by at most p / (R - p) of the hand's way, and by at most the hand's way where
// the surface is flat or concave. The way of a surface that moves counts like the hand's. A hand
// that is farther beyond an edge than R makes the proxy slip off it.

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
    constexpr double kFloor = 5e-6;  // [m] a twentieth of the clearance
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

class ProxySliding : public ProxyWith {
 protected:
  /// The hand's tip goes along `curve`, from -1 to 1, at several speeds. It comes from above.
  template <typename Curve>
  void expect_continuity(const GridSurface& surface, const Curve& curve) {
    HapticProxy proxy(tool_, {});
    const std::vector<ProxyOrgan> organs = {organ_of(surface)};
    Continuity continuity;
    Vector3d tip = curve(-1.0) + Vector3d(0.0, 0.0, 0.04);
    proxy.follow(hand_of(tool_, tip), organs);
    for (const double speed : {0.15, 0.5}) {
      move_hand(proxy, tool_, tip, curve(-1.0) + Vector3d(0.0, 0.0, 0.04), 0.5, organs);
      move_hand(proxy, tool_, tip, curve(-1.0), 0.2, organs);
      continuity.begin();
      constexpr int kPieces = 100;
      for (int i = -kPieces; i <= kPieces; ++i) {
        move_hand(proxy, tool_, tip, curve(static_cast<double>(i) / kPieces), speed, organs,
                  std::ref(continuity));
      }
    }
    EXPECT_GT(continuity.ticks(), 100);
  }
};

TEST_P(ProxySliding, GoesOverCreasesAndASaddle) {
  struct Row {
    std::function<double(double, double)> height;
    double width, deepest;
    int side;
  };
  const Row rows[] = {{[](double x, double) { return std::abs(x - 3e-3); }, 0.02, 1.2e-3, 31},
                      {[](double x, double) { return 0.3 * std::abs(x - 3e-3); }, 0.02, 1.2e-3, 31},
                      {[](double x, double) { return -std::abs(x); }, 0.02, 1.5e-3, 30},
                      {[](double x, double) { return -0.3 * std::abs(x); }, 0.02, 1.5e-3, 30},
                      {[](double x, double y) { return 5.0 * (x * x - y * y); }, 0.03, 2.2e-3, 40}};
  for (const auto& [height, width, deepest, side] : rows) {
    for (const double depth : {0.5e-3, deepest}) {
      expect_continuity(height_field(side, height), [&, wide = width, high = height](double t) {
        const double x = 0.04 * t, y = wide * std::sin(3.0 * t) * (wide > 0.02 ? 1.0 : 0.3);
        return Vector3d(x, y, high(x, y) + kStop - depth);
      });
    }
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
    HapticProxy proxy(tool_, {});
    Continuity continuity;
    for (int tick = 0; tick < 2000; ++tick) {
      // Down to the sphere within 100 ticks, and then slowly along it.
      const Vector3d along(0.3 * std::sin(4e-3 * tick), 0.2, 1.0);
      const double above = std::max(-1.2e-3, 3e-3 - 5e-5 * tick);
      const Vector3d tip = (0.05 + kStop + above) * along.normalized();
      continuity.add(tip, 1e-3 * speed, proxy.follow(hand_of(tool_, tip), {organ.at(tick)}));
    }
    EXPECT_GT(continuity.ticks(), 1000);
  }
}

constexpr ProxyFreedom kFreedoms[] = {ProxyFreedom::kTrocar, ProxyFreedom::kFree};
INSTANTIATE_TEST_SUITE_P(Tools, ProxyDepth, testing::ValuesIn(kFreedoms));
INSTANTIATE_TEST_SUITE_P(Tools, ProxySliding, testing::ValuesIn(kFreedoms));

// Loads: the proxy has no weight, so those of the contacts balance the pull and the twist.

/// Moves a tool down to its last pose, lets it rest, and expects balance if it touches.
/// `hand(height)` is its pose.
template <typename Hand>
bool is_in_balance(const ProxyTool& tool, const Hand& hand, double last,
                   const std::vector<ProxyOrgan>& organs) {
  HapticProxy proxy(tool, {});
  double height = 0.12;
  for (; height > last; height -= 1e-3) proxy.follow(hand(height), organs);
  for (int tick = 0; tick < 30; ++tick) proxy.follow(hand(height), organs);
  const ProxyAnswer& answer = proxy.follow(hand(height), organs);
  if (answer.state != ProxyStatus::kTouching) return false;
  const bool is_lever = tool.freedom == ProxyFreedom::kTrocar;
  Vector3d force = answer.pull, torque = answer.twist;
  for (const ProxyFace& contact : answer.contacts) {
    EXPECT_GE(contact.load, 0.0);
    const Vector3d load = contact.load * contact.contact.normal;
    force += (is_lever ? contact.contact.shaft : 1.0) * load;
    if (!is_lever) torque += (contact.contact.point - answer.center - answer.pull).cross(load);
  }
  // The proxy may stop a little before the place nearest the hand. The normals there differ by some
  // 1e-3, so a deep hand is balanced less well.
  const double residual = 5e-6 + 1e-3 * answer.pull.norm();
  EXPECT_LE(force.norm(), residual);
  EXPECT_LE(torque.norm(), 3.0 * residual * answer.size);
  return true;
}

TEST(ProxyLoads, BalanceThePullOfAToolThroughATrocar) {
  Random random(21);
  const std::vector<ProxyOrgan> organs = {organ_of(sphere(20, 40, 0.05)),
                                          organ_of(flat_sheet(10, -0.02), "sheet")};
  int touching = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Vector3d beside = random.point(0.08);
    const auto hand = [&](double height) {
      return shaft_hand({beside.x() * (0.12 - height) / 0.1, beside.y(), height});
    };
    touching += is_in_balance(shaft_tool(), hand, random.uniform(-0.06, 0.03), organs);
  }
  EXPECT_GT(touching, 10);
}

/// A shaft, or three balls on one link.
TEST(ProxyLoads, BalancePullAndTwistOfAFreeTool) {
  Random random(22);
  Link balls{"balls", {}};
  for (const Vector3d& center :
       {Vector3d(-0.02, 0.01, 0.0), Vector3d(0.02, 0.01, 0.0), Vector3d(0.0, -0.02, 0.004)}) {
    balls.parts.push_back(LinkPart::sphere(center, 4e-3));
  }
  int touching = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const bool is_shaft = trial % 2 == 0;
    const ProxyTool tool = is_shaft ? ball_tool() : ProxyTool{0.0, {balls}, ProxyFreedom::kFree};
    const Eigen::Matrix3d turn = oracle::random_turn(random.uniform(0.0, 0.6), random);
    const Vector3d beside(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0.0);
    const auto hand = [&](double height) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.linear() = turn;
      pose.translation() = beside + height * Vector3d::UnitZ();
      if (!is_shaft) return ToolPose{{Vector3d::Zero(), Vector3d::Zero()}, {pose}};
      return ToolPose{{pose * Vector3d(-0.03, 0.0, 0.0), pose * Vector3d(0.03, 0.0, 0.0)}};
    };
    const GridSurface surface = trial % 4 < 2 ? sphere(20, 40, 0.05) : flat_sheet(13, 0.05);
    touching += is_in_balance(tool, hand, random.uniform(0.01, 0.05), {organ_of(surface)});
  }
  EXPECT_GT(touching, 20);
}

}  // namespace
}  // namespace organ_collision
