// A hand that goes around a closed loop on a resting organ gains no energy from the proxy's spring.
// Where the proxy slips off an edge, the spring relaxes and energy is lost. All energies are
// divided by the stiffness [m^2].
#include <gtest/gtest.h>

#include <algorithm>

#include "proxy_hands.hpp"
#include "test/closed_surfaces.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// The work that the pull does on the hand, by the trapezoidal rule.
class Work {
 public:
  void operator()(const Vector3d& hand, const ProxyAnswer& answer) {
    if (ticks_++ > 0) sum_ += 0.5 * (pull_ + answer.pull).dot(hand - hand_);
    if (answer.state == ProxyStatus::kTouching) ++touching_;
    hand_ = hand;
    pull_ = answer.pull;
    most_ = std::max(most_, 0.5 * pull_.squaredNorm());
  }

  double sum() const { return sum_; }
  /// The most energy that was in the spring.
  double most() const { return most_; }
  long touching() const { return touching_; }

 private:
  long ticks_ = 0, touching_ = 0;
  Vector3d hand_ = Vector3d::Zero(), pull_ = Vector3d::Zero();
  double sum_ = 0.0, most_ = 0.0;
};

/// Goes around random polygons that begin above the organ. Their corners are in the box.
void expect_no_gain(const ProxyTool& tool, const GridSurface& surface,
                    const Eigen::AlignedBox3d& corners, Random& random) {
  HapticProxy proxy(tool, {});
  const std::vector<ProxyOrgan> organs = {organ_of(surface)};
  const Vector3d start(0.0, 0.0, 0.09);
  Vector3d tip = start;
  proxy.follow(hand_of(tool, tip), organs);
  for (int loop = 0; loop < 6; ++loop) {
    const double speed = random.scale(0.2, 1.0);
    Work work;
    for (int i = 0; i < 4; ++i) {
      const Vector3d share = Vector3d::Constant(0.5) + random.point(0.5);
      const Vector3d to = corners.min() + share.cwiseProduct(corners.sizes());
      move_hand(proxy, tool, tip, to, speed, organs, std::ref(work));
    }
    move_hand(proxy, tool, tip, start, speed, organs, std::ref(work));
    EXPECT_GT(work.touching(), 30) << "loop " << loop;
    EXPECT_LE(work.sum(), 1e-4 * work.most()) << "loop " << loop << " at " << speed << " m/s";
  }
}

class ProxyEnergy : public testing::TestWithParam<ProxyFreedom> {
 protected:
  ProxyTool tool() const {
    return GetParam() == ProxyFreedom::kTrocar ? shaft_tool() : ball_tool();
  }
};

TEST_P(ProxyEnergy, IsNotGainedOnASphere) {
  Random random(11);
  const Eigen::AlignedBox3d corners(Vector3d(-0.05, -0.05, -0.03), Vector3d(0.05, 0.05, 0.05));
  expect_no_gain(tool(), sphere(20, 40, 0.05), corners, random);
}

TEST_P(ProxyEnergy, IsNotGainedOnWavyTissue) {
  Random random(12);
  const Eigen::AlignedBox3d corners(Vector3d(-0.07, -0.07, -0.04), Vector3d(0.07, 0.07, 0.01));
  expect_no_gain(tool(), grid_surface(30), corners, random);
}

/// Small circles, on which the proxy slips off no edge.
TEST_P(ProxyEnergy, IsKeptWhereTheProxyDoesNotSlip) {
  const ProxyTool its_tool = tool();
  HapticProxy proxy(its_tool, {});
  const std::vector<ProxyOrgan> organs = {organ_of(sphere(20, 40, 0.05))};
  const auto place = [](int tick) {
    const double angle = 2.0 * M_PI * tick / 200.0;
    const Vector3d along(0.2 + 0.1 * std::cos(angle), 0.1 + 0.1 * std::sin(angle), 1.0);
    return Vector3d((0.0515 + 5e-4 * std::sin(3.0 * angle)) * along.normalized());
  };
  Vector3d tip(0.0, 0.0, 0.09);
  proxy.follow(hand_of(its_tool, tip), organs);
  move_hand(proxy, its_tool, tip, place(0), 0.2, organs);
  for (int loop = 0; loop < 5; ++loop) {
    Work work;
    for (int tick = 0; tick <= 200; ++tick) {
      work(place(tick), proxy.follow(hand_of(its_tool, place(tick)), organs));
    }
    EXPECT_EQ(work.touching(), 201);
    EXPECT_LE(std::abs(work.sum()), 2e-3 * work.most()) << "loop " << loop;
  }
}

INSTANTIATE_TEST_SUITE_P(Tools, ProxyEnergy,
                         testing::Values(ProxyFreedom::kTrocar, ProxyFreedom::kFree));

}  // namespace
}  // namespace organ_collision
