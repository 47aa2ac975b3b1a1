// haptic_proxy.hpp for organs that appear, are cut, and go.
#include <gtest/gtest.h>

#include "organ_collision/query/haptic_proxy.hpp"
#include "proxy_scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.003;
constexpr double kRest = kRadius + 1e-4;  // [m] from the axis to the tissue

class NewTissue : public testing::Test {
 protected:
  static ProxyOrgan organ(const std::string& name, const Shape& shape) {
    return {name, shape, nullptr, Eigen::Isometry3d::Identity()};
  }
  const ProxyAnswer& follow(double height, const std::vector<ProxyOrgan>& organs) {
    return proxy_.follow(shaft_pose(trocar_, {0.003, 0.002, height}), organs);
  }

  Vector3d trocar_{0.001, 0.004, 0.2};
  HapticProxy proxy_{{kRadius, {}, ProxyFreedom::kTrocar}, {}};
};

TEST_F(NewTissue, ACutOrganHoldsTheProxyWhereItIs) {
  follow(0.02, {organ("liver", sheet(0.0, 7))});
  const double before = follow(-0.01, {organ("liver", sheet(0.0, 7))}).proxy.axis.tip.z();
  const ProxyAnswer& cut = follow(-0.01, {organ("liver", sheet(0.0, 11))});
  EXPECT_EQ(cut.state, ProxyStatus::kTouching);
  EXPECT_FALSE(cut.is_placed_anew);
  EXPECT_NEAR(cut.proxy.axis.tip.z(), before, 1e-6);
}

TEST_F(NewTissue, AnOrganAroundTheProxyPlacesItAnewOutside) {
  const Shape floor = sheet(-0.1);
  const Shape ball = shape_of(sphere(19, 24, 0.03));
  ASSERT_EQ(follow(0.01, {organ("floor", floor)}).state, ProxyStatus::kFree);
  const ProxyAnswer& anew = follow(0.01, {organ("floor", floor), organ("ball", ball)});
  EXPECT_TRUE(anew.is_placed_anew);
  EXPECT_NE(anew.message.find("new tissue"), std::string::npos);
  EXPECT_EQ(anew.state, ProxyStatus::kTouching);
  EXPECT_GT(anew.proxy.axis.tip.norm(), 0.03);
  ASSERT_FALSE(anew.contacts.empty());
  EXPECT_EQ(anew.contacts.front().organ, 1u);
}

TEST_F(NewTissue, AnOrganBesideTheProxyPushesItAway) {
  const Shape floor = sheet(-0.1);
  ASSERT_EQ(follow(0.0, {organ("floor", floor)}).state, ProxyStatus::kFree);
  // It is nearer than the radius, but not across the axis.
  const ProxyAnswer& pushed = follow(0.0, {organ("floor", floor), organ("table", sheet(-0.002))});
  EXPECT_FALSE(pushed.is_placed_anew);
  EXPECT_EQ(pushed.state, ProxyStatus::kTouching);
  EXPECT_NEAR(pushed.proxy.axis.tip.z(), -0.002 + kRest, 1e-6);
}

TEST_F(NewTissue, FarAwayItLeavesTheGuaranteeForOtherOrgans) {
  const Shape floor = sheet(0.0), risen = sheet(0.03);
  follow(0.02, {organ("floor", floor)});
  follow(kRest - 0.001, {organ("floor", floor)});
  // The floor rises while an organ appears elsewhere. The whole shaft is swept, not only its axis.
  const ProxyAnswer& lifted =
      follow(kRest - 0.001, {organ("floor", risen), organ("roof", sheet(-0.2))});
  EXPECT_FALSE(lifted.is_placed_anew);
  EXPECT_EQ(lifted.state, ProxyStatus::kTouching);
  EXPECT_NEAR(lifted.proxy.axis.tip.z(), 0.03 + kRest, 1e-6);
}

TEST_F(NewTissue, WithoutOrgansTheProxyIsFree) {
  follow(0.02, {organ("liver", sheet(0.0))});
  ASSERT_EQ(follow(-0.02, {organ("liver", sheet(0.0))}).state, ProxyStatus::kTouching);
  const ProxyAnswer& free = follow(-0.02, {});
  EXPECT_EQ(free.state, ProxyStatus::kFree);
  EXPECT_EQ(free.pull, Vector3d::Zero());
  EXPECT_EQ(free.proxy.axis.tip.z(), -0.02);
}

TEST_F(NewTissue, TheOrderOfOrgansDoesNotMatter) {
  const Shape floor = sheet(0.0), deep = sheet(-0.02);
  follow(0.02, {organ("floor", floor), organ("deep", deep)});
  const double one = follow(-0.01, {organ("floor", floor), organ("deep", deep)}).pull.norm();
  const ProxyAnswer& swapped = follow(-0.01, {organ("deep", deep), organ("floor", floor)});
  EXPECT_NEAR(swapped.pull.norm(), one, 1e-9);
  EXPECT_FALSE(swapped.is_placed_anew);
}

}  // namespace
}  // namespace organ_collision
