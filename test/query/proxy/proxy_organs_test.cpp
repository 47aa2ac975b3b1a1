// Organs that come, go, are cut, or have frames of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proxy_hands.hpp"
#include "test/closed_surfaces.hpp"
#include "test/proof/proxy/scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// The same surface without the faces that have a corner within `radius` of `center`.
GridSurface cut(GridSurface surface, const Vector3d& center, double radius) {
  const auto is_near = [&](std::uint32_t vertex) {
    const float* const at = &surface.vertices[3 * vertex];
    return (Vector3d(at[0], at[1], at[2]) - center).norm() < radius;
  };
  surface.faces.erase(std::remove_if(surface.faces.begin(), surface.faces.end(),
                                     [&](const FaceIndices& face) {
                                       return std::any_of(face.begin(), face.end(), is_near);
                                     }),
                      surface.faces.end());
  return surface;
}

class ProxyAtACut : public testing::Test {
 protected:
  ProxyAtACut() {
    move_hand(proxy_, tool_, tip_, Vector3d(0.0, 0.0, -0.01), 0.2, {organ_of(sheet_)});
  }

  const ProxyTool tool_ = shaft_tool();
  const GridSurface sheet_ = flat_sheet(40);
  HapticProxy proxy_{tool_, {}};
  Vector3d tip_ = {0.0, 0.0, 0.03};
};

TEST_F(ProxyAtACut, StaysIfTheCutIsElsewhere) {
  const std::vector<ProxyOrgan> organs = {organ_of(cut(sheet_, {0.05, 0.0, 0.0}, 0.03))};
  for (int tick = 0; tick < 20; ++tick) {
    const ProxyAnswer& answer = proxy_.follow(shaft_hand(tip_), organs);
    EXPECT_EQ(answer.state, ProxyStatus::kTouching);
    EXPECT_FALSE(answer.is_placed_anew) << answer.message;
    EXPECT_NEAR(answer.pull.z(), 0.01 + kToolRadius + ProxySettings().clearance, 1e-6);
  }
}

TEST_F(ProxyAtACut, GoesThroughTheHole) {
  const std::vector<ProxyOrgan> organs = {organ_of(cut(sheet_, Vector3d::Zero(), 0.02))};
  const ProxyAnswer* answer = nullptr;
  for (int tick = 0; tick < 20; ++tick) {
    answer = &proxy_.follow(shaft_hand(tip_), organs);
    EXPECT_FALSE(answer->is_placed_anew) << answer->message;
  }
  EXPECT_EQ(answer->state, ProxyStatus::kFree);
}

/// The surface with its coordinates rounded to 2^-17 m.
GridSurface rounded(GridSurface surface) {
  for (float& x : surface.vertices) x = std::round(x * 131072.0F) / 131072.0F;
  return surface;
}

/// Two organs in frames of their own are the same as in one frame. The frames are turned by quarter
/// turns and moved by multiples of 2^-17 m, so that no vertex is rounded.
TEST(ProxyFrames, DoNotMatter) {
  Eigen::Isometry3d T_organ_proxy = Eigen::Isometry3d::Identity();
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
  Vector3d tip(0.0, 0.0, 0.08), tip_again = tip;
  for (int i = 0; i < 12; ++i) {
    const Vector3d to(random.uniform(-0.07, 0.07), random.uniform(-0.07, 0.07),
                      random.uniform(-0.05, 0.05));
    std::vector<ProxyAnswer> answers;
    move_hand(one, tool, tip, to, 0.5, in_one,
              [&](const Vector3d&, const ProxyAnswer& answer) { answers.push_back(answer); });
    std::size_t next = 0;
    move_hand(other, tool, tip_again, to, 0.5, in_two,
              [&](const Vector3d& hand, const ProxyAnswer& answer) {
                const ProxyAnswer& expected = answers[next++];
                EXPECT_EQ(answer.state, expected.state) << hand.transpose();
                EXPECT_LE((answer.pull - expected.pull).norm(), 2e-5) << hand.transpose();
                if (answer.state == ProxyStatus::kTouching) ++touching;
              });
  }
  EXPECT_GT(touching, 200);
}

TEST(ProxyAnswers, AreTheSameAgain) {
  const auto pulls = [] {
    Random random(32);
    oracle::ProxyScene scene = oracle::make_proxy_scene("two moving", random);
    oracle::ScriptedHand hand(scene.hand, random);
    HapticProxy proxy(scene.hand.tool, scene.settings);
    std::vector<Vector3d> all;
    for (long tick = 0; tick < 1500; ++tick) {
      std::vector<ProxyOrgan> organs;
      for (oracle::ScriptedOrgan& organ : scene.organs) organs.push_back(organ.at(tick));
      all.push_back(proxy.follow(hand.next(), organs).pull);
    }
    return all;
  };
  const std::vector<Vector3d> first = pulls();
  EXPECT_GT(
      std::count_if(first.begin(), first.end(), [](const auto& pull) { return !pull.isZero(); }),
      100);
  EXPECT_EQ(first, pulls());
}

TEST(ProxyTrocar, MayMoveWhileTheTipPresses) {
  const ProxyTool tool = shaft_tool();
  HapticProxy proxy(tool, {});
  const std::vector<ProxyOrgan> organs = {organ_of(flat_sheet(20))};
  Vector3d tip(0.0, 0.0, 0.03);
  move_hand(proxy, tool, tip, Vector3d(0.0, 0.0, -0.01), 0.2, organs);
  for (int tick = 0; tick < 1000; ++tick) {
    const double angle = 2e-3 * M_PI * tick;
    ToolPose hand = shaft_hand(tip);
    hand.axis.trocar += 0.02 * Vector3d(std::sin(angle), 1.0 - std::cos(angle), 0.0);
    const ProxyAnswer& answer = proxy.follow(hand, organs);
    ASSERT_EQ(answer.state, ProxyStatus::kTouching);
    EXPECT_EQ(answer.proxy.axis.trocar, hand.axis.trocar);
    EXPECT_NEAR(answer.pull.z(), 0.01 + kToolRadius + ProxySettings().clearance, 1e-6);
    EXPECT_LE(answer.pull.head<2>().norm(), 5e-6);
  }
}

}  // namespace
}  // namespace organ_collision
