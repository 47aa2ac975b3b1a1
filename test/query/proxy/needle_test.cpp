// haptic_proxy.hpp: a needle that pierces tissue.
#include <gtest/gtest.h>

#include <cmath>

#include "proxy_scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.001;
constexpr double kPuncture = 0.004;
constexpr double kFriction = 0.001;

/// A ball of tissue of 30 mm around the origin, and a needle that comes from above.
class NeedleTest : public testing::Test {
 protected:
  /// A tick with the hand's tip there and the ball moved.
  const ProxyAnswer& tick(const Vector3d& tip, const Vector3d& ball = Vector3d::Zero()) {
    const Eigen::Vector3f by = ball.cast<float>();
    return proxy_.follow({{trocar_, tip}}, {organ_of(moved(surface_, {by[0], by[1], by[2]}))});
  }
  /// Moves the hand's tip along the trocar's vertical, by half a millimetre a tick.
  const ProxyAnswer& move_to(double height) {
    while (std::abs(height - height_) > 0.0005) {
      height_ += height > height_ ? 0.0005 : -0.0005;
      tick(above(height_));
    }
    height_ = height;
    return tick(above(height_));
  }
  Vector3d above(double height) const { return {trocar_.x(), trocar_.y(), height}; }

  GridSurface surface_ = sphere(19, 24, 0.03);
  Vector3d trocar_{0.001, 0.002, 0.1};
  double height_ = 0.05;
  HapticProxy proxy_ = make_proxy();

 private:
  static HapticProxy make_proxy() {
    ProxySettings settings;
    settings.puncture = kPuncture;
    settings.friction = kFriction;
    return {{kRadius, {}, ProxyFreedom::kTrocar}, settings};
  }
};

TEST_F(NeedleTest, PiercesAtTheThresholdAndNotBefore) {
  const double stop = move_to(0.031).proxy.axis.tip.z();
  EXPECT_EQ(move_to(stop - 0.8 * kPuncture).state, ProxyStatus::kTouching);
  const ProxyAnswer& pierced = move_to(stop - 1.2 * kPuncture);
  EXPECT_EQ(pierced.state, ProxyStatus::kPunctured);
  ASSERT_EQ(pierced.crossings.size(), 1u);
  // Only friction is left.
  EXPECT_NEAR(pierced.pull.z(), kFriction, 1e-5);
  EXPECT_NEAR(pierced.crossings[0].load.z(), -kFriction, 1e-4);
}

TEST_F(NeedleTest, SticksAndSlides) {
  ASSERT_EQ(move_to(0.02).state, ProxyStatus::kPunctured);
  const double tip = tick(above(0.02)).proxy.axis.tip.z();
  EXPECT_NEAR(tip, 0.02 + kFriction, 1e-5);
  EXPECT_NEAR(tick(above(0.02 + 1.9 * kFriction)).proxy.axis.tip.z(), tip, 1e-5) << "it sticks";
  EXPECT_NEAR(tick(above(0.025)).proxy.axis.tip.z(), 0.025 - kFriction, 1e-5) << "it slides";
}

TEST_F(NeedleTest, StopsAtTheNextFaceUntilItPiercesIt) {
  ASSERT_EQ(move_to(0.0).state, ProxyStatus::kPunctured);
  const ProxyAnswer& stopped = move_to(-0.032);
  EXPECT_EQ(stopped.state, ProxyStatus::kPunctured);
  EXPECT_EQ(stopped.crossings.size(), 1u);
  EXPECT_NEAR(stopped.proxy.axis.tip.z(), -0.0299, 3e-4);
  const ProxyAnswer& through = move_to(-0.036);
  EXPECT_EQ(through.crossings.size(), 2u);
  EXPECT_NEAR(through.proxy.axis.tip.z(), -0.036 + kFriction, 1e-5);
}

TEST_F(NeedleTest, IsHeldWhereItEntered) {
  ASSERT_EQ(move_to(0.01).state, ProxyStatus::kPunctured);
  const ProxyCrossing entry = tick(above(0.01)).crossings[0];
  Vector3d ball = Vector3d::Zero();
  for (int i = 0; i < 20; ++i) {
    ball += Vector3d(0.0003, -0.0002, 0.0001);
    const ProxyAnswer& moved = tick(above(0.01), ball);
    ASSERT_EQ(moved.state, ProxyStatus::kPunctured);
    const ProxyCrossing& held = moved.crossings[0];
    EXPECT_EQ(held.face, entry.face);
    EXPECT_EQ(held.barycentric, entry.barycentric);
    EXPECT_LT((held.point - entry.point - ball).norm(), 1e-7);
    // The axis goes through the point.
    const Vector3d along = (moved.proxy.axis.tip - trocar_).normalized();
    EXPECT_LT(along.cross(held.point - trocar_).norm(), 1e-9);
    EXPECT_NEAR(held.shaft, (held.point - trocar_).norm() / (moved.proxy.axis.tip - trocar_).norm(),
                1e-12);
    // The lever about the trocar is in balance.
    const Vector3d arm = held.point - trocar_, hand_arm = moved.proxy.axis.tip - trocar_;
    EXPECT_LT((arm.cross(held.load) + hand_arm.cross(moved.pull)).norm(), 1e-9);
    EXPECT_NEAR(along.dot(held.load), -along.dot(moved.pull), 1e-9);
    EXPECT_GT(std::abs(along.dot(moved.pull)), 1e-4);
  }
}

TEST_F(NeedleTest, ComesOutAndIsHeldOutsideAgain) {
  ASSERT_EQ(move_to(0.015).state, ProxyStatus::kPunctured);
  const ProxyAnswer& out = move_to(0.04);
  EXPECT_EQ(out.state, ProxyStatus::kFree);
  EXPECT_TRUE(out.crossings.empty());
  EXPECT_FALSE(out.is_placed_anew);
  const ProxyAnswer& again = move_to(0.029);
  EXPECT_EQ(again.state, ProxyStatus::kTouching);
  EXPECT_GT(again.proxy.axis.tip.z(), 0.03);
}

TEST_F(NeedleTest, EntersAnewIfItsFaceIsGone) {
  ASSERT_EQ(move_to(0.01).state, ProxyStatus::kPunctured);
  surface_ = sphere(11, 16, 0.03);
  const ProxyAnswer& cut = tick(above(0.01));
  EXPECT_TRUE(cut.is_placed_anew);
  EXPECT_NE(cut.message.find("needle"), std::string::npos);
  EXPECT_EQ(cut.state, ProxyStatus::kPunctured) << "the hand is still deep";
  EXPECT_EQ(cut.crossings.size(), 1u);
}

TEST_F(NeedleTest, LosesItsHoldIfItsEntryComesToTheTrocar) {
  ASSERT_EQ(move_to(0.02).state, ProxyStatus::kPunctured);
  const Vector3d entry = tick(above(0.02)).crossings[0].point;
  trocar_ = entry + Vector3d(0.0, 0.0, 1e-6);
  const ProxyAnswer& lost = tick(above(0.02));
  EXPECT_NE(lost.state, ProxyStatus::kPunctured);
  EXPECT_TRUE(lost.pull.allFinite());
}

}  // namespace
}  // namespace organ_collision
