#include "query/proxy/proxy_entry.hpp"

#include <gtest/gtest.h>

#include "proxy_scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kClearance = 1e-4;

/// A ball of tissue around the origin.
class ProxyEntryTest : public testing::Test {
 protected:
  ProxyEntryTest() {
    organ_ = resting(ball_);
    organ_.topology = &topology_;
    organs_ = {organ_};
  }

  ProxyEntry enter(const ProxyTool& tool, const ToolPose& hand) const {
    Tissue tissue(tool, PickerKind::kFeedback);
    tissue.set_organs(organs_);
    const auto mobility = make_mobility(tool);
    mobility->measure(hand);
    return organ_collision::enter(tool, *mobility, hand, kClearance, organs_, tissue);
  }

  ProxyTool shaft_{0.003, {}, ProxyFreedom::kTrocar};
  ProxyTool free_{0.003, {}, ProxyFreedom::kFree};
  GridSurface surface_ = sphere(9, 12, 0.03);
  Shape ball_ = shape_of(surface_);
  SurfaceTopology topology_{surface_.faces, surface_.vertices};
  OrganTick organ_;
  std::vector<OrganTick> organs_;
};

TEST_F(ProxyEntryTest, AShaftBeginsAtItsTrocar) {
  const ProxyEntry entry = enter(shaft_, shaft_pose({0.0, 0.01, 0.1}, {0.0, 0.0, 0.0}));
  ASSERT_TRUE(entry.place);
  EXPECT_EQ(entry.place->pose.axis.tip, Vector3d(0.0, 0.01, 0.1));
  EXPECT_EQ(entry.place->clearance, kClearance);
}

TEST_F(ProxyEntryTest, ATrocarInTissueIsRefused) {
  const ProxyEntry entry = enter(shaft_, shaft_pose({0.0, 0.0, 0.031}, {0.0, 0.0, 0.1}));
  EXPECT_FALSE(entry.place);
  EXPECT_NE(entry.why_not.find("trocar"), std::string::npos);
}

TEST_F(ProxyEntryTest, AFreeToolOutsideIsWhereTheHandIs) {
  const ToolPose hand = shaft_pose({0.0, 0.02, 0.1}, {0.0, 0.0, 0.05});
  const ProxyEntry entry = enter(free_, hand);
  ASSERT_TRUE(entry.place);
  EXPECT_EQ(entry.place->pose.axis.tip, hand.axis.tip);
}

/// Whether it touches, crosses the surface, or is wholly inside.
TEST_F(ProxyEntryTest, AFreeToolInTissueComesFromBeyondOnItsSide) {
  const std::vector<ToolPose> hands = {shaft_pose({0.0, 0.02, 0.1}, {0.0, 0.0, 0.031}),
                                       shaft_pose({0.0, 0.0, 0.1}, {0.0, 0.001, -0.1}),
                                       shaft_pose({0.0, 0.0, 0.01}, {0.0, 0.001, 0.005})};
  for (const ToolPose& hand : hands) {
    const ProxyEntry entry = enter(free_, hand);
    ASSERT_TRUE(entry.place);
    const ShaftAxis& axis = entry.place->pose.axis;
    EXPECT_GT(axis.tip.norm(), 0.04);
    EXPECT_GT(axis.trocar.norm(), 0.04);
    EXPECT_GT(axis.at(0.5).dot(hand.axis.at(0.5)), 0.0);
    // It does not turn.
    const Vector3d along = axis.tip - axis.trocar;
    EXPECT_LT((along - (hand.axis.tip - hand.axis.trocar)).norm(), 1e-12);
  }
}

TEST_F(ProxyEntryTest, WithoutATopologyAToolThatTouchesNothingIsOutside) {
  organs_[0].topology = nullptr;
  const ToolPose hand = shaft_pose({0.0, 0.0, 0.01}, {0.0, 0.001, 0.005});
  const ProxyEntry entry = enter(free_, hand);
  ASSERT_TRUE(entry.place);
  EXPECT_EQ(entry.place->pose.axis.tip, hand.axis.tip);
}

}  // namespace
}  // namespace organ_collision
