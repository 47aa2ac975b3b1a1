// The loads of the contacts balance the pull and the twist on the hand: the proxy has no weight.
#include <gtest/gtest.h>

#include "proxy_hands.hpp"
#include "test/closed_surfaces.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// How much may be out of balance [m]. The proxy may stop a little before the place nearest the
/// hand. The normals there differ by some 1e-3, so a deep hand is balanced less well.
double residual(const ProxyAnswer& answer) { return 5e-6 + 1e-3 * answer.pull.norm(); }

ProxyAnswer rest(HapticProxy& proxy, const ToolPose& hand, const std::vector<ProxyOrgan>& organs) {
  for (int tick = 0; tick < 30; ++tick) proxy.follow(hand, organs);
  return proxy.follow(hand, organs);
}

TEST(ProxyLoads, BalanceThePullOfAToolThroughATrocar) {
  Random random(21);
  const ProxyTool tool = shaft_tool();
  const std::vector<ProxyOrgan> organs = {organ_of(sphere(20, 40, 0.05)),
                                          organ_of(flat_sheet(10, -0.02), "sheet")};
  int touching = 0, many = 0;
  for (int trial = 0; trial < 30; ++trial) {
    HapticProxy proxy(tool, {});
    Vector3d tip(0.0, 0.0, 0.09);
    proxy.follow(shaft_hand(tip), organs);
    const Vector3d to(random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08),
                      random.uniform(-0.06, 0.03));
    move_hand(proxy, tool, tip, to, 0.5, organs);
    const ProxyAnswer answer = rest(proxy, shaft_hand(tip), organs);
    if (answer.state != ProxyStatus::kTouching) continue;
    ++touching;
    Vector3d sum = Vector3d::Zero();
    for (const ProxyContact& contact : answer.contacts) {
      EXPECT_GE(contact.load, 0.0);
      sum += contact.load * contact.contact.shaft * contact.contact.normal;
    }
    if (answer.contacts.size() > 2) ++many;
    EXPECT_LE((sum + answer.pull).norm(), residual(answer))
        << "the hand is at " << tip.transpose() << ", the pull is " << answer.pull.transpose()
        << ", and the loads sum up to " << sum.transpose();
  }
  EXPECT_GT(touching, 15);
  EXPECT_GT(many, 4);
}

/// A free tool comes from above and rests, turned by some angle.
void expect_balance(const ProxyTool& tool, const ToolPose& at_origin,
                    const std::vector<ProxyOrgan>& organs, Random& random) {
  int touching = 0;
  for (int trial = 0; trial < 10; ++trial) {
    HapticProxy proxy(tool, {});
    const Eigen::Matrix3d turn = oracle::random_turn(random.uniform(0.0, 0.6), random);
    const Vector3d beside(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0.0);
    const auto hand = [&](double height) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.linear() = turn;
      pose.translation() = beside + height * Vector3d::UnitZ();
      ToolPose moved{{pose * at_origin.axis.trocar, pose * at_origin.axis.tip}};
      for (const Eigen::Isometry3d& link : at_origin.links) moved.links.push_back(pose * link);
      return moved;
    };
    const double depth = random.uniform(0.0, 0.04);
    double height = 0.12;
    for (; height > 0.05 - depth; height -= 1e-3) proxy.follow(hand(height), organs);
    const ProxyAnswer answer = rest(proxy, hand(height), organs);
    if (answer.state != ProxyStatus::kTouching) continue;
    ++touching;
    Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
    for (const ProxyContact& contact : answer.contacts) {
      EXPECT_GE(contact.load, 0.0);
      const Vector3d load = contact.load * contact.contact.normal;
      force += load;
      torque += (contact.contact.point - answer.center - answer.pull).cross(load);
    }
    EXPECT_LE((force + answer.pull).norm(), residual(answer)) << "trial " << trial;
    EXPECT_LE((torque + answer.twist).norm(), residual(answer) * answer.size) << "trial " << trial;
  }
  EXPECT_GT(touching, 5);
}

TEST(ProxyLoads, BalancePullAndTwistOfAFreeShaft) {
  Random random(22);
  const ProxyTool tool{kToolRadius, {}, ProxyFreedom::kFree};
  const ToolPose pose{{Vector3d(-0.03, 0.0, 0.0), Vector3d(0.03, 0.0, 0.0)}};
  expect_balance(tool, pose, {organ_of(sphere(20, 40, 0.05))}, random);
  expect_balance(tool, pose, {organ_of(flat_sheet(13, 0.05))}, random);
}

TEST(ProxyLoads, BalancePullAndTwistOfFreeBalls) {
  Random random(23);
  Link link{"balls", {}};
  for (const Vector3d& center :
       {Vector3d(-0.02, 0.01, 0.0), Vector3d(0.02, 0.01, 0.0), Vector3d(0.0, -0.02, 0.004)}) {
    link.parts.push_back(LinkPart::sphere(center, 4e-3));
  }
  const ProxyTool tool{0.0, {link}, ProxyFreedom::kFree};
  const ToolPose pose{{Vector3d::Zero(), Vector3d::Zero()}, {Eigen::Isometry3d::Identity()}};
  expect_balance(tool, pose, {organ_of(sphere(20, 40, 0.05))}, random);
  expect_balance(tool, pose, {organ_of(flat_sheet(13, 0.05))}, random);
}

}  // namespace
}  // namespace organ_collision
