#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "clearance_trials.hpp"
#include "exact_distance.hpp"
#include "exact_sides.hpp"
#include "geometry/distance/first_touch.hpp"
#include "link_trials.hpp"
#include "placement_trials.hpp"
#include "step_oracle.hpp"
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

/// Some trials of each kind, at rest and moving.
std::vector<ToolStep> make_steps() {
  std::vector<ToolStep> steps;
  for (std::size_t kind = 0; kind < trial_kinds().size(); ++kind) {
    Random random(kind);
    for (int i = 0; i < 3; ++i) {
      steps.push_back(make_resting_shaft(kind, random).step);
      steps.push_back(make_moving_shaft(kind, random).step);
    }
  }
  for (std::size_t kind = 0; kind < link_trial_kinds().size(); ++kind) {
    Random random(kind);
    for (std::size_t part = 0; part < link_part_kinds().size(); ++part) {
      steps.push_back(make_resting_link(kind, part, random).step);
      steps.push_back(make_moving_link(kind, part, random).step);
    }
  }
  return steps;
}

/// What exact arithmetic decides, and a search that samples distances on the way.
TEST(StepOracle, agrees_with_exact_arithmetic_and_finds_the_closest_approach) {
  Random random(1);
  for (const ToolStep& step : make_steps()) {
    const double fraction = random.chance(0.2) ? 1.0 : random.uniform(0.0, 1.0);
    const double distance = rounded_distance(step, fraction);
    EXPECT_TRUE(is_within(step, fraction, distance + 2e-9)) << step;
    if (distance + surface_radius(step) > 3e-9) {
      EXPECT_FALSE(is_within(step, fraction, distance - 2e-9)) << step;
    }
    double sampled = rounded_distance(step, 1.0);
    for (int i = 0; i < 200; ++i) sampled = std::min(sampled, rounded_distance(step, i / 200.0));
    double closest = 0.0;
    EXPECT_FALSE(stays_above(step, sampled + 1e-6, closest)) << step;
    double low = -surface_radius(step) - 1e-6, high = sampled + 1e-6;
    while (high - low > 1e-5) {
      const double middle = 0.5 * (low + high);
      (stays_above(step, middle, closest) ? low : high) = middle;
    }
    EXPECT_FALSE(stays_above(step, high, closest)) << step;
    EXPECT_LE(closest, high + 1e-8) << step;
  }
}

/// The library's first touch is a different search. Both have a tolerance, so motions that come
/// within a micrometre of the distance are left to either.
TEST(PassageOracle, AgreesWithFirstTouch) {
  Random random(1);
  long passed = 0;
  const auto triangle = [&] {
    return Triangle{random.point(0.05), random.point(0.05), random.point(0.05)};
  };
  for (int trial = 0; trial < 3000; ++trial) {
    const ShaftMotion segment{{random.point(0.1), random.point(0.1)},
                              {random.point(0.1), random.point(0.1)}};
    const FaceMotion face{triangle(), triangle()};
    const double distance = random.scale(1e-5, 0.05);
    const bool is_passed = passes(segment, face, distance);
    const auto touch = first_touch(segment, face, distance + (is_passed ? 1e-6 : -1e-6));
    EXPECT_EQ(touch.has_value(), is_passed) << "trial " << trial;
    passed += is_passed;
  }
  EXPECT_GT(passed, 300);
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
