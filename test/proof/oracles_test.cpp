#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exact_sides.hpp"
#include "placement_trials.hpp"
#include "test/closed_surfaces.hpp"
#include "test/proof/proxy/organ_oracle.hpp"
#include "test/proof/proxy/referee.hpp"
#include "test/query/proxy/proxy_scenes.hpp"
#include "trials.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

/// The winding number by the sum of the solid angles of all faces (Van Oosterom and Strackee 1983).
double solid_angles(const Vector3d& point, const std::vector<Triangle>& faces) {
  double sum = 0.0;
  for (const Triangle& face : faces) {
    const Vector3d a = face[0] - point, b = face[1] - point, c = face[2] - point;
    const double below = a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                         b.dot(c) * a.norm() + c.dot(a) * b.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), below);
  }
  return sum / (4.0 * M_PI);
}

TEST(ExactSides, winds_as_often_as_the_solid_angles_say) {
  Random random(3);
  int inside = 0, twice = 0;
  for (int i = 0; i < 3000; ++i) {
    const PlacementTrial trial = make_placement_trial(0, random);
    const int winding = exact_winding(trial.faces, trial.axis.tip);
    EXPECT_NEAR(winding, solid_angles(trial.axis.tip, trial.faces), 1e-6) << trial;
    inside += winding != 0;
    twice += std::abs(winding) == 2;
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(twice, 10);
}

// The referee notices each kind of broken promise.

const ProxyTool kShaft{3e-3, {}, ProxyFreedom::kTrocar};
const ProxySettings kSettings;
const double kStop = kShaft.radius + kSettings.clearance;  // [m]

ToolPose pose(const Vector3d& tip) { return {{Vector3d(0.0, 0.0, 0.3), tip}, {}, {}}; }

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

TEST_F(RefereeTest, NoticesAProxyThatIsTooNearOrSqueezedWithoutNeed) {
  begin(above_);
  const Vector3d near = above_ - 0.51 * kSettings.clearance * Vector3d::UnitZ();
  show(deep_, answer_at(near, deep_));
  EXPECT_EQ(referee_.tally().near, 1);
  ProxyAnswer squeezed = answer_at(near, deep_);
  squeezed.state = ProxyStatus::kSqueezed;
  organs_ = {organ_of(turned_over(grid_cube(4, 0.025F)))};
  show(deep_, squeezed);
  EXPECT_EQ(referee_.tally().broken(), 1) << "the organ may have moved";
  show(deep_, answer_at(above_, deep_));
  squeezed = answer_at(above_, deep_);
  squeezed.state = ProxyStatus::kSqueezed;
  show(deep_, squeezed);
  EXPECT_EQ(referee_.tally().inconsistent, 1);
}

TEST_F(RefereeTest, NoticesAProxyThatPassedThroughASheetButNotAroundIt) {
  GridSurface sheet = grid_surface(9);  // at z = 0.05 m, from -0.1 to 0.1 m
  for (std::size_t i = 2; i < sheet.vertices.size(); i += 3) sheet.vertices[i] = 0.05F;
  organs_ = {organ_of(sheet)};
  is_closed_ = false;
  begin({0.12, 0.0, 0.04});
  const Vector3d above(0.06, 0.0, 0.06), below(0.01, 0.0, 0.04);
  show(above, answer_at(above, above));
  EXPECT_EQ(referee_.tally().through, 0);
  ProxyAnswer answer = answer_at(below, below);
  // The whole tool is below, so that only the way can tell.
  answer.proxy.axis.trocar = Vector3d(0.01, 0.0, 0.01);
  show(below, answer);
  EXPECT_EQ(referee_.tally().through, 1);
}

TEST_F(RefereeTest, NoticesAProxyInsideAClosedOrgan) {
  begin(above_);
  ProxyAnswer answer = answer_at(deep_, deep_);
  answer.is_placed_anew = true;
  show(deep_, answer, true);
  EXPECT_EQ(referee_.tally().inside, 1);
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
