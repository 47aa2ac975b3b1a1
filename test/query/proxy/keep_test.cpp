// haptic_proxy.hpp: on which side of a closed organ the proxy stays (ProxyOrgan::keep), whatever
// the hand does.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "proxy_scenes.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/proxy/referee.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

/// A closed organ somewhere in the proxy's frame, and an exact oracle that tells its sides.
struct ClosedOrgan {
  ClosedOrgan(const GridSurface& surface, const Isometry3d& T_organ_proxy, std::uint32_t revision)
      : topology(surface.faces, surface.vertices) {
    organ.name = "bladder";
    organ.shape = std::make_shared<TriangleMesh>(surface.vertices, surface.triangles(), revision);
    organ.T_organ_proxy = T_organ_proxy;
    oracle.set_shape(organ.shape);
  }

  std::vector<ProxyOrgan> kept(Side keep) {
    organ.topology = &topology;
    organ.keep = keep;
    return {organ};
  }
  Side side(const Vector3d& point) const {
    return oracle.winding(organ.T_organ_proxy * point) == 0 ? Side::kOutside : Side::kInside;
  }

  SurfaceTopology topology;
  ProxyOrgan organ;
  oracle::OrganOracle oracle;
};

/// The ball of a hand in a hollow sphere whose radius is 5 cm.
class ProxyInASphere : public testing::Test {
 protected:
  const ProxyAnswer& follow(const Vector3d& center, Side keep) {
    return proxy_.follow(ball_hand(center), sphere_.kept(keep));
  }

  ClosedOrgan sphere_{sphere(60, 120, 0.05), Isometry3d::Identity(), 1};
  HapticProxy proxy_{ball_tool(), {}};
};

TEST_F(ProxyInASphere, IsHeldByTheWall) {
  Random random(43);
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3d direction = random.direction();
    const double depth = random.uniform(1e-3, 0.03);  // of the hand beyond the wall
    proxy_.reset();
    const ProxyAnswer* answer = nullptr;
    for (const double at : {0.0, 0.02, 0.05 - kStop + depth}) {
      for (int tick = 0; tick < 20; ++tick) answer = &follow(at * direction, Side::kInside);
    }
    EXPECT_EQ(answer->state, ProxyStatus::kTouching);
    // The facets are up to 70 um within the sphere.
    EXPECT_NEAR(answer->pull.norm(), depth, 1e-4);
    EXPECT_LT(-direction.dot(answer->pull.normalized()), 1.0 + 1e-9);
    EXPECT_GT(-direction.dot(answer->pull.normalized()), std::cos(5.0 * M_PI / 180.0)) << depth;
  }
}

TEST_F(ProxyInASphere, StartsAnewOnTheOtherSideIfThatOneIsToBeKept) {
  Random random(44);
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3d hand = random.uniform(0.0, 0.04) * random.direction();
    const Side side = trial % 2 == 0 ? Side::kInside : Side::kUnknown;
    proxy_.reset();
    follow(hand, side);
    EXPECT_FALSE(follow(hand, Side::kInside).is_placed_anew) << "it is there";
    const ProxyAnswer& out = follow(hand, Side::kOutside);
    EXPECT_TRUE(out.is_placed_anew);
    EXPECT_NE(out.state, ProxyStatus::kFree);
    EXPECT_FALSE(follow(hand, Side::kOutside).is_placed_anew);
  }
}

TEST_F(ProxyInASphere, StartsAnewAfterAJumpAndAReset) {
  const Vector3d in(0.0, 0.01, 0.02), out(0.0, 0.0, 0.09);
  follow(in, Side::kUnknown);
  EXPECT_TRUE(follow(out, Side::kUnknown).pull.isZero()) << "it jumped";
  for (double z = 0.09; z > 0.02; z -= 1e-3) follow({0.0, 0.0, z}, Side::kUnknown);
  EXPECT_FALSE(follow(in, Side::kUnknown).pull.isZero()) << "it came from outside";
  proxy_.reset();
  EXPECT_TRUE(follow(in, Side::kUnknown).pull.isZero());
}

// The surface is inspected in the background, so its sides may be known only later.
TEST_F(ProxyInASphere, IsPlacedOnTheRightSideOnceTheSidesAreKnown) {
  const Vector3d in(0.0, 0.01, 0.02);
  std::vector<ProxyOrgan> organs = sphere_.kept(Side::kOutside);
  organs[0].topology = nullptr;
  EXPECT_TRUE(proxy_.follow(ball_hand(in), organs).pull.isZero());
  const ProxyAnswer& known = follow(in, Side::kOutside);
  EXPECT_TRUE(known.is_placed_anew);
  EXPECT_GT(known.proxy.axis.tip.norm(), 0.05);
  EXPECT_FALSE(follow(in, Side::kOutside).is_placed_anew);
}

TEST_F(ProxyInASphere, EntersThroughATrocarOnTheRightSideOnly) {
  for (const bool is_trocar_inside : {false, true}) {
    for (const Side keep : {Side::kUnknown, Side::kOutside, Side::kInside}) {
      HapticProxy proxy(shaft_tool(), {});
      const Vector3d trocar(0.0, 0.0, is_trocar_inside ? 0.03 : 0.1);
      const ProxyAnswer& answer = proxy.follow({{trocar, {0.001, 0.0, -0.1}}}, sphere_.kept(keep));
      const Side side = is_trocar_inside ? Side::kInside : Side::kOutside;
      const bool is_right = keep == Side::kUnknown || keep == side;
      EXPECT_EQ(answer.state, is_right ? ProxyStatus::kTouching : ProxyStatus::kNoAnswer);
      EXPECT_EQ(answer.message.find("(keep)") == std::string::npos, is_right) << answer.message;
      if (is_right) {
        EXPECT_EQ(sphere_.side(answer.proxy.axis.tip), side);
      }
    }
  }
}

TEST(ProxyKeep, OfAnOpenSurfaceIsTheSideWhereTheToolStarts) {
  ClosedOrgan sheet(flat_sheet(9), Isometry3d::Identity(), 1);
  HapticProxy proxy(ball_tool(), {});
  for (const Side keep : {Side::kUnknown, Side::kOutside, Side::kInside}) {
    for (const double height : {0.01, -0.01}) {
      proxy.reset();
      EXPECT_TRUE(proxy.follow(ball_hand({0.0, 0.0, height}), sheet.kept(keep)).pull.isZero());
      const ProxyAnswer& through = proxy.follow(ball_hand({0.0, 0.0, -height}), sheet.kept(keep));
      EXPECT_NEAR(through.pull.z(), (kStop + 0.01) * (height > 0.0 ? 1.0 : -1.0), 1e-6);
    }
  }
}

}  // namespace
}  // namespace organ_collision
