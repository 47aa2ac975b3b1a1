// haptic_proxy.hpp: clearances of each organ and part of the tool. proxy_proof --clearance 0 tries
// many more scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "proxy_scenes.hpp"
#include "test/proof/proxy/referee.hpp"
#include "test/proof/proxy/scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

constexpr long kTicks = 1000;

/// The organs of a scene, and a sheet beside them, with their clearances.
class TwoOrgans {
 public:
  TwoOrgans(oracle::ProxyScene& scene, Random& random)
      : scene_(scene),
        sheet_("another", oracle::make_proxy_scene("folds", random).organs[0].at(0)),
        tables_{oracle::random_clearances(scene.hand.tool, random),
                oracle::random_clearances(scene.hand.tool, random)} {
    sheet_.T_organ_proxy = Eigen::Translation3d(0.0, 0.0, 0.03) *
                           Eigen::AngleAxisd(random.uniform(0.0, 0.6), random.direction());
  }
  std::vector<ProxyOrgan> at(long tick) {
    std::vector<ProxyOrgan> organs = {scene_.organs[0].at(tick), sheet_};
    for (std::size_t i = 0; i < 2; ++i) organs[i].clearances = tables_[i];
    return organs;
  }

 private:
  struct Named : ProxyOrgan {
    Named(const std::string& its_name, const ProxyOrgan& organ) : ProxyOrgan(organ) {
      name = its_name;
      topology = nullptr;
    }
  };
  oracle::ProxyScene& scene_;
  Named sheet_;
  std::vector<double> tables_[2];
};

TEST(ClearanceTable, EachPartKeepsItsOwnClearanceFromEachOrgan) {
  oracle::ProxyTally all;
  unsigned long seed = 20;
  for (const std::string kind : {"shaft with jaws", "free ball jaws", "free box jaws moving"}) {
    for (int episode = 0; episode < 3; ++episode) {
      SCOPED_TRACE(testing::Message() << kind << ' ' << seed);
      Random random(++seed);
      oracle::ProxyScene scene = oracle::make_proxy_scene(kind, random);
      scene.hand.speed = 0.2;  // A fast hand is ahead of its proxy.
      TwoOrgans organs(scene, random);
      oracle::ScriptedHand hand(scene.hand, random);
      HapticProxy proxy(scene.hand.tool, scene.settings);
      oracle::Referee referee(scene.hand.tool, scene.settings,
                              [](const std::string& what) { ADD_FAILURE() << what; });
      for (long tick = 0; tick < kTicks; ++tick) {
        const ToolPose& pose = hand.next();
        const std::vector<ProxyOrgan> now = organs.at(tick);
        const ProxyAnswer& answer = proxy.follow(pose, now);
        referee.check(pose, hand.jumped(), now, {scene.organs[0].is_closed(), false}, answer);
        for (const ProxyFace& face : answer.contacts) {
          const auto part = static_cast<std::size_t>(face.contact.link + 1);
          EXPECT_EQ(face.clearance, now[face.organ].clearances[part]);
          EXPECT_GT(face.clearance, 0.0) << "an organ that does not hold the link";
        }
      }
      all.add(referee.tally());
    }
  }
  EXPECT_GT(all.touching, 1000);
  EXPECT_GE(static_cast<double>(all.at_clearance), 0.99 * static_cast<double>(all.touching));
}

/// Two balls beside each other, 30 mm apart.
struct TwoBalls {
  static ProxyTool tool() {
    const LinkPart ball = LinkPart::sphere(Vector3d::Zero(), kToolRadius);
    return {0.0, {{"left", {ball}}, {"right", {ball}}}, ProxyFreedom::kFree};
  }
  static ToolPose at(double height) {
    ToolPose pose{{Vector3d::Zero(), Vector3d::Zero()}};
    for (const double side : {-0.015, 0.015}) {
      pose.links.emplace_back(Eigen::Translation3d(side, 0.002, height));
    }
    return pose;
  }
};

TEST(ClearanceTable, AnOrganHoldsOnlyTheLinksThatItDoesNotIgnore) {
  // Two sheets 10 mm apart. The right link passes through the upper one, and the left one through
  // both. Closed organs are told which side is to keep.
  for (const bool is_closed : {false, true}) {
    GridSurface upper = is_closed ? sphere(20, 30, 0.06) : flat_sheet(8);
    for (std::size_t i = 2; is_closed && i < upper.vertices.size(); i += 3) {
      upper.vertices[i] -= 0.06F;
    }
    ProxyOrgan top = organ_of(upper, "top"), bottom = organ_of(flat_sheet(9, -0.01), "bottom");
    const SurfaceTopology topology(top.shape->faces(), top.shape->vertices());
    if (is_closed) top.topology = &topology;
    HapticProxy proxy(TwoBalls::tool(), {});
    top.clearances = {0.0, 0.0, 0.0};
    bottom.clearances = {1e-3, 0.0, 4e-4};
    const ProxyAnswer* answer = nullptr;
    for (int tick = 0; tick < 120; ++tick) {
      answer = &proxy.follow(TwoBalls::at(0.02 - 4e-4 * tick), {top, bottom});
      ASSERT_NE(answer->state, ProxyStatus::kNoAnswer);
      EXPECT_EQ(answer->is_placed_anew, tick == 0) << answer->message;
    }
    EXPECT_EQ(answer->state, ProxyStatus::kTouching);
    const double right = answer->proxy.links[1].translation().z();
    EXPECT_NEAR(right, -0.01 + kToolRadius + 4e-4, 1e-5);
    EXPECT_LT(answer->proxy.links[0].translation().z(), -0.01);
    for (const ProxyFace& face : answer->contacts) EXPECT_EQ(face.contact.link, 1);
    // Where the top is to hold them again, the proxy comes anew from its right side.
    top.clearances = {1e-4, 1e-4, 1e-4};
    if (!is_closed) continue;
    EXPECT_TRUE(proxy.follow(TwoBalls::at(0.02 - 4e-4 * 119), {top, bottom}).is_placed_anew);
  }
}

TEST(ClearanceTable, ALinkInsideAnOrganThatIsToHoldItAgainIsPlacedAnew) {
  // The right ball is deep in a small organ, and touches nothing of it. The left one is outside.
  GridSurface surface = sphere(20, 30, 0.012);
  for (std::size_t i = 0; i < surface.vertices.size(); i += 3) surface.vertices[i] += 0.015F;
  ProxyOrgan organ = organ_of(surface, "organ");
  const SurfaceTopology topology(organ.shape->faces(), organ.shape->vertices());
  organ.topology = &topology;
  HapticProxy proxy(TwoBalls::tool(), {});
  organ.clearances = {0.0, 1e-4, 0.0};
  for (int tick = 0; tick < 60; ++tick) {
    const double height = std::max(0.0, 0.03 - 1e-3 * tick);
    EXPECT_EQ(proxy.follow(TwoBalls::at(height), {organ}).state, ProxyStatus::kFree);
  }
  organ.clearances = {0.0, 1e-4, 1e-4};
  const ProxyAnswer& answer = proxy.follow(TwoBalls::at(0.0), {organ});
  EXPECT_TRUE(answer.is_placed_anew);
  EXPECT_GT((answer.proxy.links[1].translation() - Vector3d(0.015, 0.0, 0.0)).norm(), 0.012);
}

TEST(ClearanceTable, AClearanceThatFallsLetsTheProxyGoAtOnceAndOneThatRisesDoesNotSqueezeIt) {
  ProxyOrgan floor = organ_of(flat_sheet(12), "floor");
  floor.clearances = {1e-3, 2e-3, 5e-4};
  HapticProxy proxy(TwoBalls::tool(), {});
  const auto height = [&](double hand) {
    const ProxyAnswer& answer = proxy.follow(TwoBalls::at(hand), {floor});
    EXPECT_NE(answer.state, ProxyStatus::kSqueezed);
    return answer.proxy.links[0].translation().z() - kToolRadius;
  };
  for (const double hand : {0.02, 0.01, 0.0, -0.005, -0.005}) height(hand);
  EXPECT_NEAR(height(-0.005), 2e-3, 2e-6);
  floor.clearances = {1e-3, 3e-4, 3e-4};
  EXPECT_NEAR(height(-0.005), 3e-4, 2e-6);
  for (int tick = 0; tick < 5; ++tick) {
    floor.clearances[1] *= 1.5;
    EXPECT_NEAR(height(-0.005), floor.clearances[1], 2e-6);
  }
}

}  // namespace
}  // namespace organ_collision
