#include "query/rotation_subdivision.hpp"

#include <gtest/gtest.h>

#include "geometry/tool/rigid_motion.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d pose(double angle, double x) {
  return Eigen::Translation3d(x, 0.0, 0.1) *
         Eigen::AngleAxisd(angle, Vector3d(1.0, 2.0, 3.0).normalized());
}

ToolWaypoint waypoint(double fraction, double angle) {
  return {fraction,
          {{0.0, 0.0, 0.0}, {0.1 * fraction, 0.2, 0.3}},
          {pose(0.1, 0.0), pose(angle, fraction)}};
}

TEST(RotationSubdivision, LeaveRotationSubdivisionAsTheyAre) {
  const ToolPath path = {waypoint(0.0, 0.0), waypoint(0.4, 0.19), waypoint(1.0, 0.3)};
  ToolPath finer;
  EXPECT_EQ(&with_subdivided_rotations(path, finer), &path);
  const ToolPath rest = {waypoint(0.0, 2.0)};
  EXPECT_EQ(&with_subdivided_rotations(rest, finer), &rest);
}

TEST(RotationSubdivision, DivideLongOnesAlongTheSameWay) {
  const ToolPath path = {waypoint(0.0, 0.0), waypoint(0.5, 0.1), waypoint(1.0, 3.0)};
  ToolPath finer;
  ASSERT_EQ(&with_subdivided_rotations(path, finer), &finer);
  EXPECT_EQ(finer.size(), 2U + 15U);
  EXPECT_EQ(finer.front().fraction, 0.0);
  EXPECT_EQ(finer.back().fraction, 1.0);
  EXPECT_EQ(finer.back().links[1].matrix(), path.back().links[1].matrix());
  const RigidMotion whole(path[1].links[1], path[2].links[1]);
  for (std::size_t i = 1; i < finer.size(); ++i) {
    const ToolWaypoint &from = finer[i - 1], &to = finer[i];
    EXPECT_GT(to.fraction, from.fraction);
    EXPECT_LE(RigidMotion(from.links[1], to.links[1]).angle(), 0.2);
    if (to.fraction <= 0.5) continue;
    const double time = 2.0 * (to.fraction - 0.5);
    EXPECT_TRUE(to.links[1].isApprox(whole.at(time), 1e-14));
    EXPECT_NEAR(to.axis.tip.x(), 0.1 * to.fraction, 1e-15);
  }
}

// A rotation by pi has no unique shortest path. Any of them may be taken.
TEST(RotationSubdivision, DivideHalfATurn) {
  ToolPath path = {waypoint(0.0, 0.0), waypoint(1.0, 0.0)};
  path[1].links[1].linear() = Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  path[0].links[1].linear().setIdentity();
  ToolPath finer;
  EXPECT_EQ(with_subdivided_rotations(path, finer).size(), 17U);
}

}  // namespace
}  // namespace organ_collision
