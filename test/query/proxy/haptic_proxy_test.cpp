// haptic_proxy.hpp: what is refused; organs that come, go, are cut, or have frames of their own;
// and tissue that closes in from both sides. proxy_proof shows that the proxy never passes through
// tissue.
#include "organ_collision/query/haptic_proxy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "proxy_scenes.hpp"
#include "test/proof/proxy/referee.hpp"
#include "test/proof/proxy/scenes.hpp"
#include "test/refusals.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_refusal(const std::function<void()>& act, const std::vector<std::string>& words) {
  expect_words(refusal_by<std::invalid_argument>(act), words);
}

TEST(ProxyRefusal, NamesIllegalSettings) {
  using Settings = ProxySettings;
  struct Row {
    std::string name;
    std::function<void(Settings&, double)> set;
    std::vector<double> illegal;
  };
  const Row rows[] = {
      {"clearance", [](Settings& s, double x) { s.clearance = x; }, {0.0, -0.25, kNan, kInfinity}},
      {"row_reach", [](Settings& s, double x) { s.row_reach = x; }, {-1e-3, kNan, kInfinity}},
      {"jump", [](Settings& s, double x) { s.jump = x; }, {0.0, -1.0, kNan}},
      {"puncture", [](Settings& s, double x) { s.puncture = x; }, {0.0, -1.0, kNan}},
      {"friction", [](Settings& s, double x) { s.friction = x; }, {-1e-3, kNan, kInfinity}}};
  HapticProxy proxy(shaft_tool(), {});
  for (const auto& [name, set, illegal] : rows) {
    for (const double value : illegal) {
      Settings settings;
      set(settings, value);
      expect_refusal([&] { HapticProxy(shaft_tool(), settings); }, {name, "must be"});
      expect_refusal([&] { proxy.set_settings(settings); }, {name, "must be"});
    }
  }
  Settings settings;
  settings.clearance = -0.25;
  expect_refusal([&] { proxy.set_settings(settings); }, {"-0.25"});
}

TEST(ProxyRefusal, NamesIllegalTools) {
  const auto make = [](const ProxyTool& tool, const ProxySettings& settings = {}) {
    return [=] { HapticProxy(tool, settings); };
  };
  for (const double radius : {-1.5, kNan, kInfinity}) {
    expect_refusal(make({radius, {}, ProxyFreedom::kTrocar}), {"radius", "must be"});
  }
  expect_refusal(make({-1.5, {}, ProxyFreedom::kTrocar}), {"-1.5"});
  expect_refusal(make({0.0, {}, ProxyFreedom::kFree}), {"shaft", "links"});
  expect_refusal(make({0.0, {{"empty", {}}}, ProxyFreedom::kFree}), {"parts"});
  const Link ball{"ball", {LinkPart::sphere(Vector3d::Zero(), 1e-3)}};
  expect_refusal(make({0.0, {ball}, ProxyFreedom::kTrocar}), {"trocar"});
  ProxySettings needle;
  needle.puncture = 1e-3;
  expect_refusal(make(ball_tool(), needle), {"puncture", "trocar"});
}

TEST(ProxyRefusal, OfAHandOrAnOrganChangesNothing) {
  using Hand = ToolPose;
  using Organs = std::vector<ProxyOrgan>;
  const std::pair<const char*, std::function<void(Hand&, Organs&)>> rows[] = {
      {"finite", [](Hand& hand, Organs&) { hand.axis.tip.x() = kNan; }},
      {"finite", [](Hand& hand, Organs&) { hand.axis.trocar.y() = kInfinity; }},
      {"1e+06", [](Hand& hand, Organs&) { hand.axis.tip.z() = 1e7; }},
      {"links", [](Hand& hand, Organs&) { hand.links.push_back(Isometry3d::Identity()); }},
      {"'organ'", [](Hand&, Organs& organs) { organs.push_back(organs[0]); }},
      {"'organ'", [](Hand&, Organs& organs) { organs[0].shape = nullptr; }},
      {"surface", [](Hand&, Organs& organs) { organs[0].keep = Side::kOnSurface; }},
      {"'organ'", [](Hand&, Organs& organs) { organs[0].T_organ_proxy.translation().x() = kNan; }},
      {"clearances",
       [](Hand&, Organs& organs) {
         organs[0].clearances = {1e-3, 1e-3};
       }},
      {"-1", [](Hand&, Organs& organs) { organs[0].clearances = {-1.0}; }},
      {"'organ'", [](Hand&, Organs& organs) { organs[0].clearances = {kInfinity}; }},
      {"advanced", [](Hand&, Organs& organs) { organs[0].most_advance = kNan; }},
      {"approaches", [](Hand&, Organs& organs) { organs[0].most_approach = -1.0; }},
      {"rotation", [](Hand&, Organs& organs) { organs[0].T_organ_proxy.linear() *= 2.0; }}};
  const ProxyTool tool = shaft_tool();
  const Organs organs = {organ_of(grid_surface(20))};
  HapticProxy one(tool, {}), other(tool, {});
  Vector3d tip(0.0, 0.0, 0.05), tip_again = tip, to(0.01, 0.02, -0.03);
  for (const auto& [word, spoil] : rows) {
    to.y() += 0.004;
    const Vector3d pull = move_hand(one, tool, tip, to, 0.3, organs)->pull;
    EXPECT_EQ(pull, move_hand(other, tool, tip_again, to, 0.3, organs)->pull) << word;
    EXPECT_FALSE(pull.isZero());
    Hand hand = shaft_hand(tip);
    Organs spoiled = organs;
    spoil(hand, spoiled);
    expect_refusal([&] { one.follow(hand, spoiled); }, {word});
  }
}

/// A shaft whose trocar is above the origin.
class ProxyTissue : public testing::Test {
 protected:
  const ProxyAnswer& follow(double height, const std::vector<ProxyOrgan>& organs) {
    return proxy_.follow({{trocar_, {0.003, 0.002, height}}}, organs);
  }

  Vector3d trocar_{0.001, 0.004, 0.2};
  HapticProxy proxy_{shaft_tool(), {}};
};

TEST_F(ProxyTissue, ThatIsCutLetsTheProxyThroughTheHole) {
  GridSurface cut = flat_sheet(40);
  follow(0.02, {organ_of(cut)});
  ASSERT_EQ(follow(-0.01, {organ_of(cut)}).state, ProxyStatus::kTouching);
  cut.faces.erase(std::remove_if(cut.faces.begin(), cut.faces.end(),
                                 [&](const FaceIndices& face) {
                                   const float* const at = &cut.vertices[3 * face[0]];
                                   return std::hypot(at[0], at[1]) < 0.02F;
                                 }),
                  cut.faces.end());
  ProxyStatus state = ProxyStatus::kNoAnswer;
  for (int tick = 0; tick < 20; ++tick) {
    const ProxyAnswer& answer = follow(-0.01, {organ_of(cut)});
    EXPECT_FALSE(answer.is_placed_anew) << answer.message;
    state = answer.state;
  }
  EXPECT_EQ(state, ProxyStatus::kFree);
}

// The floor's frame jumps past a ball, so that the ball touches it neither before nor afterwards.
TEST(ProxyFrames, JumpingPastAToolTakeItAlong) {
  HapticProxy proxy(ball_tool(), {});
  ProxyOrgan floor = organ_of(flat_sheet(7), "floor");
  proxy.follow(ball_hand({0.0, 0.0, 0.01}), {floor});
  floor.T_organ_proxy.translation().z() = -0.03;
  const ProxyAnswer& lifted = proxy.follow(ball_hand({0.0, 0.0, 0.01}), {floor});
  EXPECT_FALSE(lifted.is_placed_anew);
  EXPECT_EQ(lifted.state, ProxyStatus::kTouching);
  EXPECT_NEAR(lifted.proxy.axis.tip.z(), 0.03 + kStop, 1e-6);
}

/// The surface with its coordinates rounded to 2^-17 m.
GridSurface rounded(GridSurface surface) {
  for (float& x : surface.vertices) x = std::round(x * 131072.0F) / 131072.0F;
  return surface;
}

/// Two organs in frames of their own, in any order, are the same as in one frame. The frames are
/// turned by quarter turns and moved by multiples of 2^-17 m, so that no vertex is rounded.
TEST(ProxyFrames, DoNotMatter) {
  Isometry3d T_organ_proxy = Isometry3d::Identity();
  T_organ_proxy.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  T_organ_proxy.translation() = Vector3d(0.125, -0.03125, 0.25);
  const GridSurface ball = rounded(sphere(12, 24, 0.04));
  const GridSurface sheet = rounded(flat_sheet(10, -0.03));
  GridSurface moved = ball;
  for (std::size_t i = 0; i < moved.vertices.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> vertex(&moved.vertices[i]);
    vertex = (T_organ_proxy * vertex.cast<double>()).cast<float>();
  }
  ProxyOrgan in_its_frame = organ_of(moved, "ball");
  in_its_frame.T_organ_proxy = T_organ_proxy;
  const ProxyTool tool = shaft_tool();
  HapticProxy one(tool, {}), other(tool, {});
  const std::vector<ProxyOrgan> in_one = {organ_of(ball, "ball"), organ_of(sheet, "sheet")};
  const std::vector<ProxyOrgan> in_two = {organ_of(sheet, "sheet"), in_its_frame};
  Random random(31);
  long touching = 0;
  Vector3d tip(0.0, 0.0, 0.08);
  for (int i = 0; i < 12; ++i) {
    const Vector3d to(random.uniform(-0.07, 0.07), random.uniform(-0.07, 0.07),
                      random.uniform(-0.05, 0.05));
    move_hand(one, tool, tip, to, 0.5, in_one, [&](const Vector3d& hand, const auto& expected) {
      const ProxyAnswer& answer = other.follow(shaft_hand(hand), in_two);
      EXPECT_EQ(answer.state, expected.state) << hand.transpose();
      EXPECT_LE((answer.pull - expected.pull).norm(), 2e-5) << hand.transpose();
      if (answer.state == ProxyStatus::kTouching) ++touching;
    });
  }
  EXPECT_GT(touching, 200);
}

/// The distance between two jaws that close and open again, at 5 mm/s [m].
double gap_at(int tick) {
  return std::max(4e-3, 0.012 - 5e-6 * tick) + std::max(0.0, 5e-6 * (tick - 2400));
}

/// A closed box, 60 mm wide and 5 mm thick. Its middle is 1 mm above the origin.
GridSurface slab() {
  GridSurface box = grid_cube(4, 0.015F);
  for (std::size_t i = 0; i < box.vertices.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> at(&box.vertices[i]);
    at = (at.array() - 0.03F) * Eigen::Array3f(1.0F, 1.0F, 5.0F / 60.0F);
    at.z() += 1e-3F;
  }
  return box;
}

TEST(ProxySqueeze, HoldsTissueBetweenJawsThatClose) {
  // Two boxes along x, whose inner faces are `gap` apart.
  const LinkPart box = LinkPart::box(Eigen::Isometry3d::Identity(), {0.02, 4e-3, 2e-3});
  const ProxyTool tool{0.0, {{"upper", {box}}, {"lower", {box}}}, ProxyFreedom::kFree};
  const auto hand = [](double gap) {
    ToolPose pose{{Vector3d::Zero(), Vector3d::Zero()}};
    for (const double side : {1.0, -1.0}) {
      pose.links.emplace_back(Eigen::Translation3d(0.0, 0.0, side * (0.5 * gap + 1e-3)));
    }
    return pose;
  };
  const std::vector<ProxyOrgan> organs = {organ_of(slab())};
  HapticProxy proxy(tool, {});
  oracle::Referee referee(tool, {}, [](const std::string& what) { ADD_FAILURE() << what; });
  long squeezed = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const double gap = gap_at(tick);
    const ProxyAnswer& answer = proxy.follow(hand(gap), organs);
    referee.check(hand(gap), false, organs, {true}, answer);
    if (answer.state == ProxyStatus::kSqueezed) ++squeezed;
    if (gap < 5e-3) {
      EXPECT_EQ(answer.state, ProxyStatus::kSqueezed) << gap;
    } else if (gap > 5.2e-3) {
      EXPECT_NE(answer.state, ProxyStatus::kSqueezed) << gap;
    }
  }
  EXPECT_GT(squeezed, 500);
}

}  // namespace
}  // namespace organ_collision
