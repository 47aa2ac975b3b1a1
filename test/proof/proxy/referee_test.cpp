// The referee notices each kind of broken promise.
#include "test/proof/proxy/referee.hpp"

#include <gtest/gtest.h>

#include "test/closed_surfaces.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

const ProxyTool kShaft{3e-3, {}, ProxyFreedom::kTrocar};
const ProxySettings kSettings;
const double kStop = kShaft.radius + kSettings.clearance;  // [m]

ToolPose pose(const Vector3d& tip) { return {{Vector3d(0.0, 0.0, 0.3), tip}, {}, {}}; }

ProxyOrgan organ_of(const GridSurface& surface) {
  ProxyOrgan organ;
  organ.shape = std::make_shared<TriangleMesh>(surface.vertices, surface.triangles());
  return organ;
}

/// The right answer for a proxy at this place.
ProxyAnswer answer_at(const Vector3d& tip, const Vector3d& hand) {
  ProxyAnswer answer;
  answer.proxy = pose(tip);
  answer.pull = tip - hand;
  answer.state = answer.pull.isZero() ? ProxyStatus::kFree : ProxyStatus::kTouching;
  return answer;
}

class RefereeTest : public testing::Test {
 protected:
  /// One tick.
  void show(const Vector3d& hand, const ProxyAnswer& answer, bool jumped = false) {
    referee_.check(pose(hand), jumped, organs_, {is_closed_}, answer);
  }
  /// The first tick.
  void begin(const Vector3d& tip) {
    ProxyAnswer answer = answer_at(tip, tip);
    answer.is_placed_anew = true;
    show(tip, answer);
  }
  /// Many ticks in which the proxy stays.
  void rest(const Vector3d& tip, const Vector3d& hand) {
    for (int tick = 0; tick < 600; ++tick) show(hand, answer_at(tip, hand));
  }

  /// A sheet at z = 0.05 m, from -0.1 to 0.1 m, instead of the cube.
  void put_sheet() {
    GridSurface sheet = grid_surface(9);
    for (std::size_t i = 2; i < sheet.vertices.size(); i += 3) sheet.vertices[i] = 0.05F;
    organs_ = {organ_of(sheet)};
    is_closed_ = false;
  }

  std::vector<ProxyOrgan> organs_ = {organ_of(turned_over(grid_cube(4, 0.025F)))};
  bool is_closed_ = true;
  std::vector<std::string> blamed_;
  Referee referee_{kShaft, kSettings, [this](const std::string& what) { blamed_.push_back(what); }};
  // The cube is from 0 to 0.1 m.
  const Vector3d above_ = {0.05, 0.05, 0.1 + kStop}, deep_ = {0.05, 0.05, 0.08};
};

TEST_F(RefereeTest, HasNothingToSayAboutAProxyThatStops) {
  begin(above_);
  rest(above_, deep_);
  EXPECT_TRUE(blamed_.empty()) << blamed_.front();
  EXPECT_EQ(referee_.tally().broken(), 0);
  EXPECT_EQ(referee_.tally().touching, 600);
  EXPECT_NEAR(referee_.tally().least, kSettings.clearance, 1e-8);
}

TEST_F(RefereeTest, NoticesAProxyThatIsTooNear) {
  begin(above_);
  const Vector3d near = above_ - 0.51 * kSettings.clearance * Vector3d::UnitZ();
  show(deep_, answer_at(near, deep_));
  EXPECT_EQ(referee_.tally().near, 1);
  ProxyAnswer squeezed = answer_at(near, deep_);
  squeezed.state = ProxyStatus::kSqueezed;
  organs_ = {organ_of(turned_over(grid_cube(4, 0.025F)))};
  show(deep_, squeezed);
  EXPECT_EQ(referee_.tally().broken(), 1);
}

TEST_F(RefereeTest, NoticesAProxyThatSaysSqueezedWithoutNeed) {
  begin(above_);
  ProxyAnswer answer = answer_at(above_, deep_);
  answer.state = ProxyStatus::kSqueezed;
  show(deep_, answer);
  EXPECT_EQ(referee_.tally().inconsistent, 1);
}

TEST_F(RefereeTest, NoticesAProxyThatPassedThroughASheet) {
  put_sheet();
  begin({0.01, 0.0, 0.06});
  const Vector3d below(0.01, 0.0, 0.04);
  ProxyAnswer answer = answer_at(below, below);
  // The whole tool is below, so that only the way can tell.
  answer.proxy.axis.trocar = Vector3d(0.01, 0.0, 0.01);
  show(below, answer);
  EXPECT_EQ(referee_.tally().through, 1);
}

TEST_F(RefereeTest, AcceptsAWayAroundASheet) {
  put_sheet();
  begin({0.12, 0.0, 0.04});
  const Vector3d above(0.06, 0.0, 0.06);
  show(above, answer_at(above, above));
  EXPECT_EQ(referee_.tally().through, 0);
}

TEST_F(RefereeTest, NoticesTissueThatMovedThroughTheProxy) {
  begin({0.05, 0.05, 0.12});
  organs_ = {organ_of(moved(turned_over(grid_cube(4, 0.025F)), {0.0F, 0.0F, 0.03F}))};
  const Vector3d tip(0.05, 0.05, 0.12);
  show(tip, answer_at(tip, tip));
  EXPECT_EQ(referee_.tally().near, 1);
  EXPECT_EQ(referee_.tally().through, 1);
}

TEST_F(RefereeTest, NoticesAProxyInsideAClosedOrgan) {
  begin(above_);
  ProxyAnswer answer = answer_at(deep_, deep_);
  answer.is_placed_anew = true;
  show(deep_, answer, true);
  EXPECT_EQ(referee_.tally().inside, 1);
}

TEST_F(RefereeTest, NoticesAProxyThatIsPlacedAnewWithoutNeed) {
  begin(above_);
  ProxyAnswer answer = answer_at(above_, deep_);
  answer.is_placed_anew = true;
  show(deep_, answer);
  EXPECT_EQ(referee_.tally().overrun, 1);
  show(deep_, answer_at(above_, deep_), true);
  EXPECT_EQ(referee_.tally().inconsistent, 1) << "not placed anew after a jump";
}

TEST_F(RefereeTest, NoticesAProxyThatIsHeldInTheOpen) {
  const Vector3d aside(0.05, 0.05, 0.2), hand(0.06, 0.05, 0.15);
  begin(aside);
  rest(aside, hand);
  EXPECT_GT(referee_.tally().held, 40);
}

TEST_F(RefereeTest, NoticesAnswersThatContradictThemselves) {
  begin(above_);
  ProxyAnswer answer = answer_at(above_, deep_);
  answer.state = ProxyStatus::kFree;
  show(deep_, answer);
  EXPECT_EQ(referee_.tally().inconsistent, 2) << "away from the hand, and with a pull";
  answer = answer_at(above_, deep_);
  answer.pull *= 2.0;
  show(deep_, answer);
  EXPECT_EQ(referee_.tally().inconsistent, 3);
  answer = answer_at(above_, deep_);
  answer.proxy.axis.trocar.x() += 1e-3;
  show(deep_, answer);
  EXPECT_EQ(referee_.tally().inconsistent, 4);
  answer = answer_at(above_, deep_);
  answer.twist.x() = NAN;
  show(deep_, answer);
  EXPECT_EQ(referee_.tally().inconsistent, 5);
  answer = {};
  show(deep_, answer);
  EXPECT_EQ(referee_.tally().no_answer, 1);
}

}  // namespace
}  // namespace organ_collision::oracle
