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

/// Closed surfaces of about 5 cm around the origin, in which a tool of 1 cm has room.
std::vector<GridSurface> hollow_shapes() {
  GridSurface egg = sphere(12, 17, 0.05);
  for (std::size_t i = 0; i < egg.vertices.size(); i += 3) egg.vertices[i] *= 0.6F;
  return {shuffled(sphere(20, 31, 0.04), 1), torus(16, 40, 0.045, 0.3), unwelded(egg),
          moved(grid_cube(5, 0.013F), {-0.03F, -0.02F, -0.04F})};
}

/// [m] In the frame of a link.
const std::vector<Vector3d> kBalls = {{-4e-3, 0.0, 0.0}, {4e-3, 1e-3, 0.0}, {0.0, -4e-3, 2e-3}};

/// A ball, a short shaft, and three balls on one link.
std::vector<ProxyTool> small_tools() {
  Link balls{"balls", {}};
  for (const Vector3d& center : kBalls) balls.parts.push_back(LinkPart::sphere(center, 1.5e-3));
  return {ball_tool(), {2e-3, {}, ProxyFreedom::kFree}, {0.0, {balls}, ProxyFreedom::kFree}};
}

/// The hand of one of small_tools(), by its place in that list.
ToolPose hand_at(std::size_t tool, const Isometry3d& pose) {
  const Vector3d at = pose.translation(), half = 3e-3 * pose.linear().col(0);
  if (tool == 2) return {{at, at}, {pose}};
  return tool == 0 ? ball_hand(at) : ToolPose{{at - half, at + half}};
}

/// The ends of a shaft, or the middles of the balls of a link.
std::vector<Vector3d> ends_of(const ToolPose& pose) {
  if (pose.links.empty()) return {pose.axis.trocar, pose.axis.tip};
  std::vector<Vector3d> ends = kBalls;
  for (Vector3d& end : ends) end = pose.links[0] * end;
  return ends;
}

Isometry3d any_pose(Random& random, double range) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = oracle::random_turn(random.uniform(0.0, 3.0), random);
  pose.translation() = random.point(range);
  return pose;
}

/// Runs a test for each shape, each tool, and both sides.
template <typename Test>
void for_each_hollow(const Test& test) {
  Random random(41);
  for (const GridSurface& surface : hollow_shapes()) {
    ClosedOrgan organ(surface, any_pose(random, 0.3), 1);
    for (std::size_t tool = 0; tool < small_tools().size(); ++tool) {
      SCOPED_TRACE(testing::Message() << surface.faces.size() << " faces, tool " << tool);
      test(organ, tool, random);
    }
  }
}

/// A pose near the organ, in the proxy's frame.
Isometry3d pose_near(const ClosedOrgan& organ, double range, Random& random) {
  return organ.organ.T_organ_proxy.inverse() * any_pose(random, range);
}

TEST(ProxyKeep, WhereverTheHandStartsTheProxyIsOnTheRightSide) {
  for_each_hollow([](ClosedOrgan& organ, std::size_t tool, Random& random) {
    HapticProxy proxy(small_tools()[tool], {});
    for (int trial = 0; trial < 24; ++trial) {
      const ToolPose hand = hand_at(tool, pose_near(organ, 0.07, random));
      const Side keep = static_cast<Side>(trial % 3);
      proxy.reset();
      const ProxyAnswer& answer = proxy.follow(hand, organ.kept(keep));
      const Side expected = keep == Side::kUnknown ? organ.side(ends_of(hand)[0]) : keep;
      ASSERT_NE(answer.state, ProxyStatus::kNoAnswer) << answer.message;
      for (const Vector3d& point : ends_of(answer.proxy)) {
        EXPECT_EQ(organ.side(point), expected) << trial << " at " << answer.center.transpose();
      }
    }
  });
}

// The hand goes straight through the wall, in and out. A cut makes the organ another one for the
// proxy. It may have to be placed anew, on the same side.
TEST(ProxyKeep, TheSideIsKeptWhileTheHandGoesThroughTheWallAndTheOrganIsCut) {
  long touching = 0;
  for_each_hollow([&](ClosedOrgan& organ, std::size_t tool, Random& random) {
    for (const Side keep : {Side::kInside, Side::kUnknown}) {
      HapticProxy proxy(small_tools()[tool], {});
      oracle::Referee referee(small_tools()[tool], {},
                              [](const auto& what) { ADD_FAILURE() << what; });
      Isometry3d from = pose_near(organ, 0.05, random);
      const ToolPose start = hand_at(tool, from);
      ProxyAnswer answer = proxy.follow(start, organ.kept(keep));
      referee.check(start, false, organ.kept(keep), {false}, answer);
      const Side expected = keep == Side::kUnknown ? organ.side(ends_of(start)[0]) : keep;
      for (int leg = 0; leg < 6; ++leg) {
        const Isometry3d to = pose_near(organ, 0.07, random);
        const Vector3d way = to.translation() - from.translation();
        constexpr int kTicks = 80;
        for (int tick = 0; tick < kTicks; ++tick) {
          from.translation() += way / kTicks;
          const ToolPose hand = hand_at(tool, from);
          const std::vector<ProxyOrgan> organs = organ.kept(keep);
          answer = proxy.follow(hand, organs);
          referee.check(hand, false, organs, {false}, answer);
          if (answer.state == ProxyStatus::kTouching) ++touching;
        }
        for (const Vector3d& point : ends_of(answer.proxy)) {
          EXPECT_EQ(organ.side(point), expected) << "leg " << leg;
        }
      }
      std::vector<ProxyOrgan> cut = organ.kept(keep);
      const TriangleMesh& shape = *cut[0].shape;
      std::vector<std::uint32_t> triangles;
      for (const auto& [a, b, c] : shape.faces()) triangles.insert(triangles.end(), {b, c, a});
      cut[0].shape = std::make_shared<TriangleMesh>(shape.vertices(), triangles, 2);
      const ProxyAnswer& after = proxy.follow(hand_at(tool, from), cut);
      EXPECT_FALSE(after.is_placed_anew) << after.message;
      EXPECT_EQ(organ.side(ends_of(after.proxy)[0]), expected);
    }
  });
  EXPECT_GT(touching, 1000);
}

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
