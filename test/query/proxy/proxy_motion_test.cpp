#include "query/proxy/proxy_motion.hpp"

#include <gtest/gtest.h>

#include "proxy_scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.003;
constexpr double kClearance = 1e-4;
constexpr double kRest = kRadius + kClearance;  // [m] from the axis to the tissue

class ProxyMotionTest : public testing::Test {
 protected:
  ProxyMotionTest() { motion_.set_clearance(kClearance); }

  ProxyPlace place(const Vector3d& tip, double clearance = kClearance) const {
    return {shaft_pose(trocar_, tip), clearance};
  }

  Vector3d trocar_{0.004, 0.003, 0.2};
  ProxyTool tool_{kRadius, {}, ProxyFreedom::kTrocar};
  std::unique_ptr<Mobility> mobility_ = make_mobility(tool_);
  Tissue tissue_{tool_, PickerKind::kFeedback};
  ProxyMotion motion_{*mobility_, tissue_};
  std::vector<OrganTick> organs_;
};

TEST_F(ProxyMotionTest, FliesToTheHandOrToTheTissue) {
  const Shape floor = sheet(0.0);
  organs_ = {resting(floor)};
  tissue_.set_organs(organs_);
  ProxyPlace now = place({0.011, 0.001, 0.05});
  EXPECT_TRUE(motion_.fly(now, place({0.012, 0.001, 0.01}).pose));
  EXPECT_EQ(now.pose.axis.tip, Vector3d(0.012, 0.001, 0.01));
  EXPECT_FALSE(motion_.fly(now, place({0.012, 0.001, -0.02}).pose));
  EXPECT_NEAR(now.pose.axis.tip.z(), kRest, 1e-9);
}

TEST_F(ProxyMotionTest, SlidesToThePlaceNearestTheHand) {
  const Shape floor = sheet(0.0);
  organs_ = {resting(floor)};
  tissue_.set_organs(organs_);
  ProxyPlace now = place({0.012, 0.001, kRest});
  motion_.slide(now, place({0.0145, -0.0012, -0.004}).pose, 0.005);
  EXPECT_NEAR(now.pose.axis.tip.x(), 0.0145, 1e-6);
  EXPECT_NEAR(now.pose.axis.tip.y(), -0.0012, 1e-6);
  EXPECT_NEAR(now.pose.axis.tip.z(), kRest, 1e-6);
  EXPECT_NEAR(now.clearance, kClearance, 1e-6);
  ASSERT_FALSE(motion_.contacts().empty());
  EXPECT_EQ(motion_.contacts().size(), motion_.walls().size());
}

TEST_F(ProxyMotionTest, LeavesTheTissueWithTheHand) {
  const Shape floor = sheet(0.0);
  organs_ = {resting(floor)};
  tissue_.set_organs(organs_);
  ProxyPlace now = place({0.012, 0.001, kRest});
  const ToolPose hand = place({0.012, 0.001, 0.03}).pose;
  motion_.slide(now, hand, 0.001);
  EXPECT_EQ(now.pose.axis.tip, hand.axis.tip);
}

TEST_F(ProxyMotionTest, ReachesAHandInTheAirHoweverNear) {
  const Shape floor = sheet(0.0);
  organs_ = {resting(floor)};
  tissue_.set_organs(organs_);
  ProxyPlace now = place({0.012, 0.001, 0.03});
  const ToolPose hand = place({0.012, 0.001 + 5e-7, 0.03}).pose;
  motion_.slide(now, hand, 0.001);
  EXPECT_EQ(now.pose.axis.tip, hand.axis.tip);
}

TEST_F(ProxyMotionTest, GivesWayToTissueThatRises) {
  for (const double rise : {0.0005, 0.005, 0.05}) {
    const Shape low = sheet(0.0), high = sheet(rise);
    organs_ = {moving(low, high)};
    const ProxyPlace start = place({0.012, 0.001, kRest});
    const auto now = motion_.give_way(start, start.pose, organs_);
    ASSERT_TRUE(now) << rise;
    EXPECT_NEAR(now->pose.axis.tip.z(), rise + kRest, 1e-6) << rise;
    EXPECT_GE(now->clearance, 0.5 * kClearance);
  }
}

TEST_F(ProxyMotionTest, DoesNotMoveWhereNothingMoves) {
  const Shape floor = sheet(0.0);
  organs_ = {resting(floor)};
  const ProxyPlace start = place({0.012, 0.001, kRest});
  const auto now = motion_.give_way(start, place({0.02, 0.0, -0.01}).pose, organs_);
  ASSERT_TRUE(now);
  EXPECT_EQ(now->pose.axis.tip, start.pose.axis.tip);
}

TEST_F(ProxyMotionTest, StaysInTheMiddleWhereTissueClosesIn) {
  // Two sheets at right angles to x come within 4 mm of each other; the shaft is 6 mm thick.
  GridSurface upright = grid_surface(7);
  for (std::size_t i = 0; i < upright.vertices.size(); i += 3) {
    upright.vertices[i + 2] = upright.vertices[i];
    upright.vertices[i] = 0.0F;
  }
  const auto wall = [&](double x) { return shape_of(upright, translation(x, 0.0, 0.0)); };
  const Shape left = wall(-0.006), right = wall(0.006);
  const Shape left_closed = wall(-0.002), right_closed = wall(0.002);
  trocar_ = {0.0, 0.003, 0.15};
  organs_ = {moving(left, left_closed), moving(right, right_closed)};
  const ProxyPlace start = place({0.0, 0.001, 0.03});
  const auto given = motion_.give_way(start, start.pose, organs_);
  ASSERT_TRUE(given);
  ProxyPlace now = *given;
  motion_.slide(now, place({0.01, 0.001, 0.03}).pose, 0.001);
  EXPECT_NEAR(now.clearance, -0.001, 1e-5) << "the axis is in the middle";
  // They open again.
  organs_ = {moving(left_closed, left), moving(right_closed, right)};
  const auto freed = motion_.give_way(now, now.pose, organs_);
  ASSERT_TRUE(freed);
  now = *freed;
  motion_.slide(now, place({0.0, 0.001, 0.03}).pose, 0.001);
  EXPECT_LT((now.pose.axis.tip - Vector3d(0.0, 0.001, 0.03)).norm(), 1e-12);
}

}  // namespace
}  // namespace organ_collision
