// The path of a tool that turns fast: between the transforms that TF received, it is what TF
// interpolates, and not the straight line between samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/tool/leg_motion.hpp"
#include "node/motion/tool_poses.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "test/node/tools/hand_made_tools.hpp"
#include "test/query/scenes.hpp"
#include "tool_poses_fixture.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

constexpr double kStartTime = 10.0;  // [s]
constexpr double kTipRadius = 1e-3;

/// How the tip hangs on what turns.
enum class Mount { kOffset, kStaticFrame, kRepeatedFrame };

/// A liver that rests in the world, and a tool whose tip is carried by a marker. The marker turns
/// by up to 3 rad in 8 to 58 ms; TF gets its pose at the start, at the end, and once in between.
struct Turn {
  Turn(Mount mount, double most, Random& random)
      : end(kStartTime + 1e-3 * random.integer(8, 58)), tool(shaft_tool("pointer", kTipRadius)) {
    const Isometry3d T_world_liver = oracle::random_pose(0.3, random);
    set_transform(buffer, "world", "liver", 0.0, T_world_liver, true);
    const Vector3d tip = random.scale(0.02, 0.3) * random.direction();
    Isometry3d marker = oracle::random_pose(0.0, random);
    marker.translation() = T_world_liver * random.point(0.05) - marker.linear() * tip;
    for (const double time : {kStartTime, kStartTime + 0.4 * (end - kStartTime), end}) {
      set_transform(buffer, "world", "marker", time, marker);
      marker.linear() *= oracle::random_turn(0.5 * random.scale(0.3 * most, most), random);
      marker.translation() += random.scale(1e-4, 0.02) * random.direction();
      if (mount == Mount::kRepeatedFrame) set_point(buffer, "marker", "pointer_tip", time, tip);
    }
    if (mount == Mount::kStaticFrame) set_point(buffer, "marker", "pointer_tip", 0.0, tip, true);
    if (mount == Mount::kOffset) {
      tool.parameters.tip_frame = "marker";
      tool.parameters.tip_offset = tip;
    }
    if (random.chance(0.5)) {
      tool.parameters.trocar_frame = "marker";
      tool.parameters.trocar_offset = random.point(0.1);
    } else {
      set_point(buffer, "liver", "pointer_trocar", 0.0, {0.0, 0.0, 0.25}, true);
    }
  }

  ToolPose pose(double fraction) {
    const auto found =
        ToolPoses(buffer, {0.001, 100})
            .pose(tool, "liver", ros::Time(kStartTime + fraction * (end - kStartTime)));
    if (!found.found) throw std::runtime_error(found.why_not);
    return found.found->value;
  }
  SampledPath path(int samples_max = 100) {
    return ToolPoses(buffer, {0.001, samples_max})
        .path(tool, "liver", {pose(0.0), ros::Time(kStartTime)}, {pose(1.0), ros::Time(end)});
  }

  double end;  ///< [s]
  Tool tool;
  TransformBuffer buffer;
};

/// [m] The largest distance of the tool from its path, at 300 times.
double deviation(Turn& turn, const ToolPath& path) {
  double most = 0.0;
  std::size_t leg = 1;
  for (int i = 0; i <= 300; ++i) {
    const double fraction = i / 300.0;
    while (leg + 1 < path.size() && path[leg].fraction < fraction) ++leg;
    const ToolWaypoint &from = path[leg - 1], &to = path[leg];
    const double time = (fraction - from.fraction) / (to.fraction - from.fraction);
    const ShaftAxis found = ShaftMotion{from.axis, to.axis, to.arcs}.at(time);
    const ShaftAxis right = turn.pose(fraction).axis;
    most = std::max({most, (found.trocar - right.trocar).norm(), (found.tip - right.tip).norm()});
  }
  return most;
}

std::set<std::uint32_t> faces(const CollisionResult& result) {
  std::set<std::uint32_t> found;
  for (const FaceContact& contact : result.contacts) found.insert(contact.face);
  return found;
}

}  // namespace

// Stamps of the poses that are compared are rounded to nanoseconds.
TEST(TurningTools, APathConsistsOfTheArcsOnWhichTheTipMoves) {
  Random random(31);
  for (int i = 0; i < 200; ++i) {
    Turn turn(i % 2 == 0 ? Mount::kOffset : Mount::kStaticFrame, 3.0, random);
    const SampledPath sampled = turn.path();
    EXPECT_EQ(sampled.unknown, "");
    EXPECT_EQ(sampled.path.size(), 3U) << "one leg from each transform to the next";
    ASSERT_LE(deviation(turn, sampled.path), 1e-6) << "turn " << i;
  }
}

TEST(TurningTools, WhatIsNoArcIsSampledUntilItIsFollowedToAMicrometre) {
  Random random(32);
  for (int i = 0; i < 50; ++i) {
    Turn turn(Mount::kRepeatedFrame, 0.3, random);
    const SampledPath sampled = turn.path(1000);
    EXPECT_EQ(sampled.unknown, "");
    ASSERT_LE(deviation(turn, sampled.path), 1.5e-6) << "turn " << i;
  }
  std::size_t cut = 0;
  for (int i = 0; i < 10; ++i) {
    Turn fast(Mount::kRepeatedFrame, 3.0, random);
    const SampledPath sampled = fast.path();
    ASSERT_LE(sampled.path.size(), 101U) << "never more than motion_samples_max legs";
    const bool is_told = sampled.unknown.find("motion_samples_max") != std::string::npos;
    EXPECT_EQ(is_told, deviation(fast, sampled.path) > 1.5e-6);
    cut += is_told;
  }
  EXPECT_GT(cut, 5U);
}

TEST(TurningTools, TheOrganAndLinksMayTurnToo) {
  const auto turned = [](double angle, const Vector3d& at) {
    return Isometry3d(Eigen::Translation3d(at) * Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
  };
  TransformBuffer buffer;
  for (const double angle : {0.0, 0.4}) {
    const double time = kStartTime + 0.05 * angle;
    set_transform(buffer, "world", "liver", time, turned(angle, {0.1, 0.0, 0.0}));
    set_transform(buffer, "world", "arm/wrist", time, turned(-angle, {0.0, 0.3, 0.0}));
  }
  set_point(buffer, "arm/wrist", "arm/jaw", 0.0, {0.2, 0.0, 0.0}, true);
  const Tool tool = grasper();
  const ToolPoses poses(buffer, {0.001, 1000});
  const auto pose = [&](double time) {
    return *poses.pose(tool, "liver", ros::Time(kStartTime + time)).found;
  };
  const SampledPath sampled = poses.path(tool, "liver", pose(0.0), pose(0.02));
  EXPECT_EQ(sampled.unknown, "");
  for (std::size_t leg = 1; leg < sampled.path.size(); ++leg) {
    const ToolWaypoint &from = sampled.path[leg - 1], &to = sampled.path[leg];
    const ToolPose right = pose(0.01 * (from.fraction + to.fraction)).value;
    for (std::size_t i = 0; i < 2; ++i) {
      const Isometry3d found = RigidMotion(from.links[i], to.links[i]).at(0.5);
      EXPECT_LE((found.translation() - right.links[i].translation()).norm(), 2.1e-6);
    }
  }
}

// Poses along the arc are tested one by one. What each of them touches, the step touches.
TEST(TurningTools, EveryFaceThatTheArcTouchesIsFoundAndNoOther) {
  Random random(33);
  CollisionQuery query{PickerSettings{PickerKind::kCpu}};
  CollisionResult result;
  std::size_t touched = 0, by_arc_alone = 0;
  for (int i = 0; i < 60; ++i) {
    Turn turn(i % 2 == 0 ? Mount::kOffset : Mount::kStaticFrame, 3.0, random);
    const TriangleMesh organ = mesh(scattered_faces(150, random));
    CollisionRequest request = swept(organ, turn.path().path, kTipRadius);
    query.evaluate(request, result);
    const std::vector<FaceContact> contacts = result.contacts;
    const std::set<std::uint32_t> found = faces(result);
    touched += found.size();
    for (ToolWaypoint& waypoint : request.path) waypoint.arcs = {};
    query.evaluate(request, result);
    by_arc_alone += faces(result) != found;

    request.mode = QueryMode::kStatic;
    const auto touched_at = [&](double fraction, double radius) {
      request.path = resting_path(turn.pose(fraction));
      request.radius = radius;
      query.evaluate(request, result);
      return faces(result);
    };
    for (int k = 0; k <= 300; ++k) {
      for (const std::uint32_t face : touched_at(k / 300.0, kTipRadius - 1e-6)) {
        ASSERT_EQ(found.count(face), 1U) << "turn " << i << ", face " << face;
      }
    }
    for (const FaceContact& contact : contacts) {
      ASSERT_EQ(touched_at(contact.fraction, kTipRadius + 1e-5).count(contact.face), 1U)
          << "turn " << i << ", face " << contact.face;
    }
  }
  EXPECT_GT(touched, 500U);
  EXPECT_GT(by_arc_alone, 20U) << "arcs must matter";
}

}  // namespace organ_collision
