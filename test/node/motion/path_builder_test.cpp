#include "node/motion/path_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/tool/leg_motion.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr std::size_t kAll = 10'000;  ///< legs
const ShaftAxis kNowhere{Vector3d::Zero(), Vector3d::Zero()};
const Vector3d kBallCenter{0.02, -0.03, 0.06};
constexpr double kBallRadius = 0.01;

/// A ball beside its link's origin. All its points are within 80 mm of the origin.
std::vector<Link> one_ball() { return {{"jaw", {LinkPart::sphere(kBallCenter, kBallRadius)}}}; }

Isometry3d pose(const Vector3d& origin, double angle, const Vector3d& axis) {
  return Eigen::Translation3d(origin) * Eigen::AngleAxisd(angle, axis.normalized());
}

/// The pose of the ball behind two joints: an arm that rotates, and the ball that rotates on it.
/// `time` in seconds.
Isometry3d on_an_arm(double time) {
  return pose({0.1, 0.2, 0.3}, 1.1 * time, {1.0, 0.3, -0.4}) *
         pose({0.0, 0.0, 0.25}, -2.3 * time, {0.2, 1.0, 0.5});
}

template <typename PoseAt>
ToolPath path_of(const std::vector<Link>& links, int steps, double duration, PoseAt pose_at) {
  PathBuilder path(links, {kNowhere, {pose_at(0.0)}});
  for (int i = 1; i <= steps; ++i) {
    const double fraction = i == steps ? 1.0 : double(i) / steps;
    path.add(fraction, {kNowhere, {pose_at(fraction * duration)}});
  }
  return path.take(kAll).path;
}

/// The pose of the link on the path at a fraction of the step.
Isometry3d at(const ToolPath& path, double fraction) {
  std::size_t leg = 1;
  while (path[leg].fraction < fraction) ++leg;
  const ToolWaypoint &a = path[leg - 1], &b = path[leg];
  return RigidMotion(a.links[0], b.links[0])
      .at((fraction - a.fraction) / (b.fraction - a.fraction));
}

}  // namespace

TEST(PathBuilder, ALinkThatTurnsSteadilyIsOneLeg) {
  std::mt19937 random(3);
  std::normal_distribution<double> number(0.0, 1.0);
  const auto vector = [&] { return Vector3d(number(random), number(random), number(random)); };
  for (int i = 0; i < 50; ++i) {
    const RigidMotion motion(pose(vector(), number(random), vector()),
                             pose(vector(), number(random), vector()));
    const ToolPath path =
        path_of(one_ball(), 20, 1.0, [&](double time) { return motion.at(time); });
    ASSERT_EQ(path.size(), 2u);
    EXPECT_EQ(path[0].links[0].matrix(), motion.start().matrix());
    EXPECT_EQ(path[1].links[0].matrix(), motion.end().matrix());
    EXPECT_EQ(path[1].fraction, 1.0);
  }
}

TEST(PathBuilder, AChainOfJointsIsFollowedToAMicrometre) {
  constexpr int kSteps = 2000;
  constexpr double kDuration = 0.4;
  const ToolPath path = path_of(one_ball(), kSteps, kDuration, on_an_arm);
  EXPECT_LT(path.size(), kSteps / 4u);
  std::mt19937 random(5);
  std::normal_distribution<double> number(0.0, 1.0);
  for (int i = 0; i <= kSteps; ++i) {
    const double fraction = double(i) / kSteps;
    const Isometry3d found = at(path, fraction), right = on_an_arm(fraction * kDuration);
    for (int k = 0; k < 20; ++k) {
      const Vector3d direction = Vector3d(number(random), number(random), number(random));
      const Vector3d point = kBallCenter + kBallRadius * direction.normalized();
      EXPECT_LE((found * point - right * point).norm(), 1e-6) << "at " << fraction;
    }
  }
}

namespace {

const Vector3d kTrocar(0.1, 0.2, 0.5);

/// Waypoints that are evenly spaced in time, with these heights of the tip.
ToolPath heights(const std::vector<double>& heights) {
  ToolPath path;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double fraction = double(i) / double(heights.size() - 1);
    path.push_back({fraction, {kTrocar, {0.3, 0.1, heights[i]}}});
  }
  return path;
}

SampledPath simplified(const ToolPath& samples, std::size_t legs) {
  PathBuilder path({}, {samples.front().axis});
  for (std::size_t i = 1; i < samples.size(); ++i) {
    path.add(samples[i].fraction, {samples[i].axis});
  }
  return path.take(legs);
}

/// [m] The distance of the waypoint from the path at the same time.
double distance(const ToolPath& path, const ToolWaypoint& waypoint) {
  std::size_t leg = 1;
  while (path[leg].fraction < waypoint.fraction) ++leg;
  const ToolWaypoint &a = path[leg - 1], &b = path[leg];
  const double time = (waypoint.fraction - a.fraction) / (b.fraction - a.fraction);
  return (ShaftMotion{a.axis, b.axis}.at(time).tip - waypoint.axis.tip).norm();
}

}  // namespace

TEST(PathBuilder, NothingIsFartherFromTheWayThanItSays) {
  std::mt19937 random(11);
  std::normal_distribution<double> number(0.0, 0.05);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> tips = {0.0};
    while (tips.size() < 60) tips.push_back(tips.back() + number(random));
    const ToolPath path = heights(tips);
    for (const std::size_t legs : {1u, 3u, 10u, 40u, 59u}) {
      const SampledPath built = simplified(path, legs);
      ASSERT_EQ(built.path.size(), legs + 1);
      EXPECT_EQ(built.samples_cut, path.size() - built.path.size());
      double farthest = 0.0;
      for (const ToolWaypoint& waypoint : path) {
        farthest = std::max(farthest, distance(built.path, waypoint));
      }
      EXPECT_NEAR(built.deviation_cut, farthest, 1e-12);
      EXPECT_EQ(built.unknown.empty(), legs == 59) << "each step is some centimetres";
      if (legs > 1) continue;
      const auto straight = [&](const ToolWaypoint& a, const ToolWaypoint& b) {
        return distance(built.path, a) < distance(built.path, b);
      };
      const auto most = std::max_element(path.begin(), path.end(), straight);
      const ToolPath two = simplified(path, 2).path;
      EXPECT_EQ(two.at(1).fraction, most->fraction) << "what matters most stays";
    }
  }
  EXPECT_EQ(simplified(resting_path({{kTrocar, kTrocar}}), 1).path.size(), 1u);
}
