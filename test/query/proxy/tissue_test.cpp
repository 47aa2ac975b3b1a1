#include "query/proxy/tissue.hpp"

#include <gtest/gtest.h>

#include "proxy_scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kRadius = 0.003;

class TissueTest : public testing::Test {
 protected:
  ProxyTool tool_{kRadius, {}, ProxyFreedom::kTrocar};
  Tissue tissue_{tool_, PickerKind::kFeedback};
  std::vector<TissueContact> contacts_;
};

TEST_F(TissueTest, DistancesAreThoseOfTheToolWithoutItsGrowth) {
  const Shape floor = sheet(0.0);
  const std::vector<OrganTick> organs = {resting(floor)};
  tissue_.set_organs(organs);
  const ToolPose pose = shaft_pose({0.013, 0.002, 0.1}, {0.011, 0.001, 0.0035});
  tissue_.touch(pose, 0.0004, contacts_);
  EXPECT_TRUE(contacts_.empty());
  for (const double growth : {0.0006, 0.002, 0.02}) {
    tissue_.touch(pose, growth, contacts_);
    ASSERT_FALSE(contacts_.empty());
    double nearest = 1.0;
    for (const TissueContact& found : contacts_) nearest = std::min(nearest, found.distance);
    EXPECT_NEAR(nearest, 0.0005, 1e-9) << growth;
  }
}

TEST_F(TissueTest, WithTheLeastGrowthAShaftIsItsAxis) {
  const Shape floor = sheet(0.0);
  const std::vector<OrganTick> organs = {resting(floor)};
  tissue_.set_organs(organs);
  const Vector3d trocar(0.013, 0.002, 0.1);
  tissue_.touch(shaft_pose(trocar, {0.011, 0.001, 2e-6}), tissue_.least_growth(), contacts_);
  EXPECT_TRUE(contacts_.empty());
  tissue_.touch(shaft_pose(trocar, {0.011, 0.001, -2e-6}), tissue_.least_growth(), contacts_);
  EXPECT_FALSE(contacts_.empty());
}

/// The same scene in another frame has the same contacts.
TEST_F(TissueTest, ContactsAreInTheProxysFrame) {
  Isometry3d T_organ_proxy(Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -1.0).normalized()));
  T_organ_proxy.translation() = Vector3d(0.03, -0.05, 0.02);
  const GridSurface wavy = grid_surface(9);
  const Shape here = shape_of(wavy), there = shape_of(wavy, T_organ_proxy);
  OrganTick elsewhere = resting(there);
  elsewhere.T_before = elsewhere.T_now = T_organ_proxy;
  const std::vector<OrganTick> organs = {resting(here), elsewhere};
  tissue_.set_organs(organs);
  const std::vector<ToolPose> way = {shaft_pose({0.0, 0.01, 0.1}, {0.03, 0.02, 0.04}),
                                     shaft_pose({0.0, 0.01, 0.1}, {-0.02, 0.01, -0.03}),
                                     shaft_pose({0.0, 0.01, 0.1}, {-0.03, -0.04, -0.03})};
  tissue_.sweep(way, 0.0, contacts_);
  const std::size_t count = contacts_.size() / 2;
  ASSERT_EQ(contacts_.size(), 2 * count);
  ASSERT_GT(count, 5u);
  for (std::size_t i = 0; i < count; ++i) {
    const FaceContact &a = contacts_[i].contact, &b = contacts_[i + count].contact;
    EXPECT_EQ(contacts_[i].organ, 0u);
    EXPECT_EQ(contacts_[i + count].organ, 1u);
    EXPECT_EQ(a.face, b.face);
    EXPECT_LT((a.point - b.point).norm(), 1e-6);
    EXPECT_LT((a.normal - b.normal).norm(), 1e-3);
    EXPECT_NEAR(a.fraction, b.fraction, 1e-5);
  }
}

TEST_F(TissueTest, SweepsOrganAndToolTogether) {
  const Shape low = sheet(0.0), high = sheet(0.05);
  const std::vector<OrganTick> organs = {moving(low, high)};
  tissue_.set_organs(organs);
  const ToolPose from = shaft_pose({0.013, 0.002, 0.2}, {0.011, 0.001, 0.01});
  const ToolPose to = shaft_pose({0.013, 0.002, 0.2}, {0.011, 0.001, 0.06});
  tissue_.sweep_with_organs(from, to, 0.0, contacts_);
  EXPECT_TRUE(contacts_.empty()) << "they move side by side";
  tissue_.sweep_with_organs(from, from, 0.0, contacts_);
  ASSERT_FALSE(contacts_.empty());
  // The tip is 10 mm above the sheet, its radius 3 mm, and the sheet moves by 50 mm.
  for (const TissueContact& found : contacts_) {
    EXPECT_GE(found.contact.fraction, 0.14 - 1e-6);
    EXPECT_LT(found.contact.normal.z(), 0.0);
  }
  EXPECT_NEAR(contacts_.front().distance, -0.043, 1e-6);
}

TEST_F(TissueTest, AMovingFrameSweepsToo) {
  const Shape floor = sheet(0.0);
  OrganTick organ = resting(floor);
  organ.T_now = translation(0.0, 0.0, -0.05);  // The organ's frame rises by 50 mm.
  const std::vector<OrganTick> organs = {organ};
  EXPECT_TRUE(organ.is_moving());
  tissue_.set_organs(organs);
  const ToolPose pose = shaft_pose({0.013, 0.002, 0.2}, {0.011, 0.001, 0.01});
  tissue_.sweep_with_organs(pose, pose, 0.0, contacts_);
  ASSERT_FALSE(contacts_.empty());
  EXPECT_NEAR(contacts_.front().distance, -0.043, 1e-6);
  EXPECT_NEAR(contacts_.front().contact.end_point.z(), 0.05, 1e-6);
}

TEST_F(TissueTest, FindsCrossingsOfAllOrgansInTheirOrderAlongTheAxis) {
  const Shape high = sheet(0.05), low = sheet(0.01), ball = shape_of(sphere(9, 12, 0.03));
  const std::vector<OrganTick> organs = {resting(low), resting(high), resting(ball)};
  tissue_.set_organs(organs);
  std::vector<TissueCrossing> crossings;
  tissue_.cross({{0.001, 0.002, 0.1}, {0.003, 0.001, -0.1}}, crossings);
  ASSERT_EQ(crossings.size(), 4u);
  EXPECT_EQ(crossings[0].organ, 1u);
  EXPECT_EQ(crossings[1].organ, 2u);
  EXPECT_EQ(crossings[2].organ, 0u);
  EXPECT_EQ(crossings[3].organ, 2u);
  EXPECT_NEAR(crossings[0].crossing.point.z(), 0.05, 1e-7);
}

TEST_F(TissueTest, KnowsTheInside) {
  const GridSurface surface = sphere(9, 12, 0.03);
  const Shape ball = shape_of(surface);
  const SurfaceTopology topology(surface.faces, surface.vertices);
  OrganTick organ = resting(ball);
  organ.topology = &topology;
  const std::vector<OrganTick> organs = {organ};
  tissue_.set_organs(organs);
  const auto is_inside = [&](const Vector3d& trocar, const Vector3d& tip) {
    return tissue_.is_inside(shaft_pose(trocar, tip), tip);
  };
  EXPECT_TRUE(is_inside({0.0, 0.0, 0.01}, {0.001, 0.0, -0.01}));
  EXPECT_TRUE(is_inside({0.0, 0.0, 0.1}, {0.001, 0.0, -0.1})) << "it goes through";
  EXPECT_FALSE(is_inside({0.0, 0.0, 0.1}, {0.001, 0.0, 0.05}));
}

}  // namespace
}  // namespace organ_collision
