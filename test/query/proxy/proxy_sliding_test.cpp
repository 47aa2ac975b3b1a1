// The pull is continuous while the proxy slides over edges that it does not slip off.
#include <gtest/gtest.h>

#include "proxy_hands.hpp"
#include "test/closed_surfaces.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// The largest change of the pull in a tick, beyond what the hand's way explains.
struct Change {
  double factor = 1.0;
  double most = 0.0;

  void operator()(const Vector3d& hand, const ProxyAnswer& answer) {
    if (answer.state != ProxyState::kTouching) was_touching = false;
    if (was_touching) {
      const double change = (answer.pull - pull).norm(), way = (hand - tip).norm();
      most = std::max(most, change - factor * way);
      ratio = std::max(ratio, change / way);
    }
    was_touching = answer.state == ProxyState::kTouching;
    pull = answer.pull;
    tip = hand;
  }

  bool was_touching = false;
  Vector3d pull = Vector3d::Zero(), tip = Vector3d::Zero();
  double ratio = 0.0;
};

/// The tip slides along `curve(t)`, t from -1 to 1, at these speeds, forth and back.
template <typename Curve>
Change slide(const ProxyTool& tool, const GridSurface& surface, double factor, const Curve& curve) {
  HapticProxy proxy(tool, {});
  const std::vector<ProxyOrgan> organs = {organ_of(surface)};
  Change change;
  change.factor = factor;
  Vector3d tip = curve(-1.0) + Vector3d(0.0, 0.0, 0.04);
  proxy.follow(hand_of(tool, tip), organs);
  for (const double speed : {0.03, 0.1, 0.4}) {
    move_hand(proxy, tool, tip, curve(-1.0), 0.2, organs);
    change.was_touching = false;
    constexpr int kPieces = 200;
    for (int i = -kPieces; i <= kPieces; ++i) {
      move_hand(proxy, tool, tip, curve(static_cast<double>(i) / kPieces), speed, organs,
                std::ref(change));
    }
  }
  return change;
}

void report(const char* what, const Change& c) { std::cerr << what << " ratio " << c.ratio << " beyond " << c.most << "\n"; }

TEST(X, Sphere) {
  for (const auto& tool : {shaft_tool(), ball_tool()})
    for (double pen : {0.5e-3, 1.5e-3, 2.5e-3}) {
      const double r = 0.05 + kToolRadius + 1e-4 - pen;
      auto c = slide(tool, sphere(20, 40, 0.05), 1.0, [&](double t) { return Vector3d(r * std::sin(0.8 * t), 0.1*r*t, r * std::cos(0.8 * t)); });
      std::cerr << pen << " "; report("sphere", c);
    }
}
TEST(X, Valley) {
  for (const auto& tool : {shaft_tool(), ball_tool()})
    for (double s : {0.3, 1.0}) for (double pen : {0.5e-3, 2.5e-3, 10e-3}) {
      auto c = slide(tool, height_field(31, [&](double x, double) { return s * std::abs(x - 0.003); }), 1.0, [&](double t) { return Vector3d(0.04 * t, 0.02 * t, s * std::abs(0.04 * t) + kToolRadius - pen); });
      std::cerr << s << " " << pen << " "; report("valley", c);
    }
}
TEST(X, Roof) {
  for (const auto& tool : {shaft_tool(), ball_tool()})
    for (double s : {0.3, 1.0}) for (double pen : {0.5e-3, 1.5e-3}) {
      auto c = slide(tool, height_field(30, [&](double x, double) { return -s * std::abs(x ); }), 1.0, [&](double t) { return Vector3d(0.04 * t, 0.02 * t, -s * std::abs(0.04 * t) + kToolRadius - pen); });
      std::cerr << s << " " << pen << " "; report("roof", c);
    }
}
TEST(X, Saddle) {
  for (const auto& tool : {shaft_tool(), ball_tool()})
    for (double pen : {0.5e-3, 1.5e-3, 2.5e-3}) {
      auto z = [](double x, double y) { return 5.0 * (x * x - y * y); };
      auto c = slide(tool, height_field(40, z), 1.0, [&](double t) { const double x = 0.04 * t, y = 0.03 * std::sin(3 * t); return Vector3d(x, y, z(x, y) + kToolRadius - pen); });
      std::cerr << pen << " "; report("saddle", c);
    }
}

}  // namespace
}  // namespace organ_collision
