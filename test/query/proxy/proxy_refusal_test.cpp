// Illegal tools, settings, hands and organs are refused by name and value, and change nothing.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "proxy_hands.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What an illegal value is refused with; empty if it is not refused.
std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_refusal(const std::function<void()>& act, const std::vector<std::string>& words) {
  const std::string what = refusal(act);
  for (const std::string& word : words) {
    EXPECT_NE(what.find(word), std::string::npos) << "'" << what << "' does not say " << word;
  }
}

void expect_refused_settings(const ProxySettings& settings, const std::vector<std::string>& words) {
  expect_refusal([&] { HapticProxy(shaft_tool(), settings); }, words);
  HapticProxy proxy(shaft_tool(), {});
  expect_refusal([&] { proxy.set_settings(settings); }, words);
}

TEST(ProxyRefusal, NamesIllegalSettings) {
  const auto with = [](const auto& change) {
    ProxySettings settings;
    change(settings);
    return settings;
  };
  for (const double clearance : {0.0, -1e-4, kNan, kInfinity}) {
    expect_refused_settings(with([&](ProxySettings& s) { s.clearance = clearance; }),
                            {"clearance", "must be"});
  }
  expect_refused_settings(with([](ProxySettings& s) { s.clearance = -0.25; }), {"-0.25"});
  for (const double jump : {0.0, -1.0, kNan}) {
    expect_refused_settings(with([&](ProxySettings& s) { s.jump = jump; }), {"jump", "must be"});
  }
  for (const double puncture : {0.0, -1.0, kNan}) {
    expect_refused_settings(with([&](ProxySettings& s) { s.puncture = puncture; }),
                            {"puncture", "must be"});
  }
  for (const double friction : {-1e-3, kNan, kInfinity}) {
    expect_refused_settings(with([&](ProxySettings& s) { s.friction = friction; }),
                            {"friction", "must be"});
  }
}

TEST(ProxyRefusal, NamesIllegalTools) {
  for (const double radius : {-1.5, kNan, kInfinity}) {
    expect_refusal(
        [&] {
          HapticProxy({radius, {}, ProxyFreedom::kTrocar}, {});
        },
        {"radius", "must be"});
  }
  expect_refusal([] { HapticProxy({-1.5, {}, ProxyFreedom::kTrocar}, {}); }, {"-1.5"});
  expect_refusal([] { HapticProxy({0.0, {}, ProxyFreedom::kFree}, {}); }, {"shaft", "links"});
  const Link empty{"empty", {}};
  expect_refusal([&] { HapticProxy({0.0, {empty}, ProxyFreedom::kFree}, {}); }, {"parts"});
  const Link ball{"ball", {LinkPart::sphere(Vector3d::Zero(), 1e-3)}};
  expect_refusal([&] { HapticProxy({0.0, {ball}, ProxyFreedom::kTrocar}, {}); }, {"trocar"});
  ProxySettings needle;
  needle.puncture = 1e-3;
  expect_refusal([&] { HapticProxy(ball_tool(), needle); }, {"puncture", "trocar"});
}

/// A tick that is refused.
struct BadTick {
  std::string name;
  ToolPose hand;
  std::vector<ProxyOrgan> organs;
};

std::vector<BadTick> bad_ticks(const Vector3d& tip, const ProxyOrgan& organ) {
  std::vector<BadTick> ticks;
  ToolPose hand = shaft_hand(tip);
  hand.axis.tip.x() = kNan;
  ticks.push_back({"finite", hand, {organ}});
  hand = shaft_hand(tip);
  hand.axis.trocar.y() = kInfinity;
  ticks.push_back({"finite", hand, {organ}});
  hand = shaft_hand(tip);
  hand.axis.tip.z() = 1e7;
  ticks.push_back({"1e+06", hand, {organ}});
  hand = shaft_hand(tip);
  hand.links.push_back(Eigen::Isometry3d::Identity());
  ticks.push_back({"links", hand, {organ}});
  hand = shaft_hand(tip);
  ticks.push_back({"'organ'", hand, {organ, organ}});
  ProxyOrgan bad = organ;
  bad.shape = nullptr;
  ticks.push_back({"'organ'", hand, {bad}});
  bad = organ;
  bad.T_organ_proxy.translation().x() = kNan;
  ticks.push_back({"'organ'", hand, {bad}});
  bad = organ;
  bad.T_organ_proxy.linear() *= 2.0;
  ticks.push_back({"rotation", hand, {bad}});
  return ticks;
}

TEST(ProxyRefusal, ChangesNothing) {
  const ProxyTool tool = shaft_tool();
  const ProxyOrgan organ = organ_of(grid_surface(20));
  HapticProxy one(tool, {}), other(tool, {});
  Vector3d tip(0.0, 0.0, 0.05), tip_again = tip;
  move_hand(one, tool, tip, Vector3d(0.01, 0.02, -0.03), 0.3, {organ});
  move_hand(other, tool, tip_again, Vector3d(0.01, 0.02, -0.03), 0.3, {organ});
  Vector3d to(-0.03, 0.0, -0.02);
  for (const BadTick& bad : bad_ticks(tip, organ)) {
    const std::string what = refusal([&] { one.follow(bad.hand, bad.organs); });
    EXPECT_NE(what.find(bad.name), std::string::npos)
        << "'" << what << "' does not say " << bad.name;
    to.y() += 0.004;
    const Vector3d pull = move_hand(one, tool, tip, to, 0.3, {organ})->pull;
    EXPECT_EQ(pull, move_hand(other, tool, tip_again, to, 0.3, {organ})->pull) << bad.name;
    EXPECT_FALSE(pull.isZero());
  }
}

TEST(ProxyRefusal, NamesAPoseOfALinkThatIsNoRotation) {
  const Link ball{"ball", {LinkPart::sphere(Vector3d::Zero(), 1e-3)}};
  HapticProxy proxy({0.0, {ball}, ProxyFreedom::kFree}, {});
  ToolPose hand{{Vector3d::Zero(), Vector3d::Zero()}, {Eigen::Isometry3d::Identity()}};
  hand.links.front().linear() *= 1.5;
  expect_refusal([&] { proxy.follow(hand, {organ_of(flat_sheet(3))}); }, {"ball", "rotation"});
}

}  // namespace
}  // namespace organ_collision
