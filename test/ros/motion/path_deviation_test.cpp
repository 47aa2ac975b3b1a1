#include "ros/motion/path_deviation.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

ToolWaypoint at(double fraction, const Vector3d& trocar, const Vector3d& tip,
                const std::vector<Isometry3d>& links = {}) {
  return {fraction, {trocar, tip}, links};
}

Isometry3d pose(const Vector3d& origin, double angle = 0.0) {
  return Eigen::Translation3d(origin) *
         Eigen::AngleAxisd(angle, Vector3d(0.3, -1.0, 0.2).normalized());
}

}  // namespace

TEST(PathDeviation, EitherEndOfTheAxisCounts) {
  const PathDeviation deviation({});
  const Vector3d trocar(0.1, 0.2, 0.3), tip(0.4, 0.1, -0.2), moved(0.04, -0.08, 0.02);
  const StraightMotion way(at(0.2, trocar, tip), at(0.6, trocar + moved, tip - moved));
  const ToolWaypoint straight = at(0.3, trocar + 0.25 * moved, tip - 0.25 * moved);
  EXPECT_NEAR(deviation(straight, way).most(), 0.0, 1e-15);
  ToolWaypoint bent = straight;
  bent.axis.tip += Vector3d(0.0, 0.003, -0.004);
  EXPECT_NEAR(deviation(bent, way).axis, 0.005, 1e-15);
  bent.axis.trocar += Vector3d(0.012, 0.0, -0.005);
  EXPECT_NEAR(deviation(bent, way).axis, 0.013, 1e-15);
  EXPECT_EQ(deviation(bent, way).links, 0.0);
}

TEST(PathDeviation, LinksCountWithAllThatTheyReach) {
  const Vector3d rest = Vector3d::Zero(), center(0.0, 0.05, 0.0);
  const PathDeviation deviation(
      {{"wrist", {LinkPart::sphere(rest, 0.01)}}, {"jaw", {LinkPart::sphere(center, 0.01)}}});
  const auto poses = [&](double fraction, const Isometry3d& wrist, const Isometry3d& jaw) {
    return at(fraction, rest, rest, {wrist, jaw});
  };
  const Isometry3d still = pose({0.1, 0.2, 0.3}, 0.4);
  const StraightMotion way(poses(0.0, still, still), poses(1.0, still, still));
  EXPECT_NEAR(deviation(poses(0.5, still, still), way).most(), 0.0, 1e-15);
  const Isometry3d aside = Eigen::Translation3d(0.0, 0.02, 0.0) * still;
  EXPECT_NEAR(deviation(poses(0.5, aside, still), way).links, 0.02, 1e-12);
  // The jaw's farthest point is 60 mm from its origin, the wrist's 10 mm.
  const Isometry3d turned = pose({0.1, 0.2, 0.3}, 0.5);
  const double wrist = deviation(poses(0.5, turned, still), way).links;
  const double jaw = deviation(poses(0.5, still, turned), way).links;
  EXPECT_GE(jaw, 0.06 * 2.0 * std::sin(0.05) - 1e-12);
  EXPECT_GT(jaw, wrist);
  EXPECT_EQ(deviation(poses(0.5, turned, turned), way).most(), jaw);
}
