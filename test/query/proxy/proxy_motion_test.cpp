#include "query/proxy/proxy_motion.hpp"

#include <gtest/gtest.h>

#include "organ_collision/query/haptic_proxy.hpp"
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

// haptic_proxy.hpp for organs that appear, are cut, and go.

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
