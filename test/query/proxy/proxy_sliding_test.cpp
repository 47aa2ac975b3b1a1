// The pull is continuous while the proxy slides over edges that it does not slip off.
//
// Around a convex edge, the proxy's tip moves on an arc whose radius R is the tool's radius plus
// the clearance. If the pull is p < R long, the hand moves on an arc of radius R - p. So the pull
// changes by at most p / (R - p) of the hand's way, and by at most the hand's way where the surface
// is flat or concave. The way of a surface that moves counts like the hand's. A hand that is
// farther beyond an edge than R makes the proxy slip off it.
#include <gtest/gtest.h>

#include <algorithm>

#include "proxy_hands.hpp"
#include "test/closed_surfaces.hpp"
#include "test/proof/proxy/scripted_organ.hpp"

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
