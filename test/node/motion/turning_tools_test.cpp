// The path of a tool on frames that turn: between the transforms that TF received, it is what TF
// interpolates, and not the straight line between samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/tool/leg_motion.hpp"
#include "node/motion/tool_poses.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/step.hpp"
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
constexpr double kExactWay = 1e-6;  // [m] What doc/theory/exactness.md says of paths.

/// A chain of 1 to 4 frames that turn and move, each with stamps of its own, and at the end of it a
/// tool with a shaft and two links. The organ rests, or it is on a chain, too.
struct TurningScene {
  /// `most`: [rad] how far each frame turns between two of its stamps.
  TurningScene(double most, Random& random, bool is_organ_at_rest = false)
      : end(kStartTime + 1e-3 * random.integer(8, 58)),
        tool(with_links(shaft_tool("hook", kTipRadius))) {
    const int count = random.integer(1, 4);
    const int of_organ = is_organ_at_rest ? 0 : std::max(0, random.integer(-1, 2));
    for (int i = 0; i < count; ++i) {
      const std::string parent = i == 0 ? "world" : frame(i - 1) + (i % 2 == 0 ? "" : "_mount");
      send_joint(parent, frame(i), most, random);
      set_transform(buffer, frame(i), frame(i) + "_mount", 0.0, offset(random), true);
    }
    std::string organ = "world";
    for (int i = 0; i < of_organ; ++i) {
      const std::string moving = "base" + std::to_string(i);
      send_joint(organ, moving, most, random);
      organ = moving;
    }
    set_transform(buffer, organ, "liver", 0.0, offset(random), true);
    tool.parameters.tip_frame = frame(count - 1);
    tool.parameters.tip_offset = random.scale(1e-5, 0.3) * random.direction();
    tool.parameters.trocar_frame =
        random.chance(0.5) ? "liver" : frame(random.integer(0, count - 1));
    tool.parameters.trocar_offset = random.scale(1e-5, 0.3) * random.direction();
    set_transform(buffer, frame(count - 1), "arm/wrist", 0.0, offset(random), true);
    // The jaw is on a joint of its own.
    send_joint("arm/wrist", "arm/jaw", most, random);
    tool.links[1].parts.push_back(
        LinkPart::box(oracle::random_pose(0.05, random), {0.01, 0.02, 0.005}));
  }

  static std::string frame(int i) { return "joint" + std::to_string(i); }
  static Isometry3d offset(Random& random) {
    Isometry3d pose = oracle::random_pose(0.0, random);
    pose.translation() = random.scale(1e-5, 0.3) * random.direction();
    return pose;
  }

  /// The stamps cover the step. The rates are constant, or they change from stamp to stamp.
  void send_joint(const std::string& parent, const std::string& child, double most,
                  Random& random) {
    const double spacing = (end - kStartTime) * random.uniform(0.3, 1.5);
    const bool is_constant = random.chance(0.3);
    Vector3d axis = random.direction(), step = random.scale(1e-5, 0.02) * random.direction();
    double angle = random.chance(0.3) ? most : random.scale(1e-4 * most, most);
    Isometry3d pose = offset(random);
    for (double time = kStartTime - spacing * random.uniform(0.0, 1.0);; time += spacing) {
      set_transform(buffer, parent, child, time, pose);
      if (time >= end) return;
      pose.linear() *= Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      pose.translation() += step;
      if (is_constant) continue;
      axis = random.direction();
      angle = random.scale(1e-4 * most, most);
      step = random.scale(1e-5, 0.02) * random.direction();
    }
  }

  /// What TF says.
  ToolPose pose(ros::Time time) const {
    const auto look_up = [&](const std::string& frame) {
      return to_eigen(static_cast<const tf2::BufferCore&>(buffer)
                          .lookupTransform("liver", frame, time)
                          .transform);
    };
    const ToolParameters& parameters = tool.parameters;
    return {{look_up(parameters.trocar_frame) * parameters.trocar_offset,
             look_up(parameters.tip_frame) * parameters.tip_offset},
            {look_up("arm/wrist"), look_up("arm/jaw")}};
  }
  ros::Time at(double fraction) const {
    return ros::Time(kStartTime + fraction * (end - kStartTime));
  }
  SampledPath path(int samples_max = 100) {
    const ros::Time from(kStartTime), to(end);
    return ToolPoses(buffer, {0.001, samples_max})
        .path(tool, "liver", {pose(from), from}, {pose(to), to});
  }

  /// [m] The largest distance of the tool from its path, as it is swept, at 1000 times.
  double deviation(const ToolPath& path) const {
    ToolPath finer;
    const ToolPath& swept = with_subdivided_rotations(path, finer);
    double most = 0.0;
    std::size_t leg = 1;
    for (int i = 0; i <= 1000; ++i) {
      const ros::Time now = at(i / 1000.0);
      const double fraction = (now - at(0.0)).toSec() / (at(1.0) - at(0.0)).toSec();
      while (leg + 1 < swept.size() && swept[leg].fraction < fraction) ++leg;
      const ToolWaypoint &from = swept[leg - 1], &to = swept[leg];
      const double time = std::min(1.0, (fraction - from.fraction) / (to.fraction - from.fraction));
      const ShaftAxis axis = ShaftMotion{from.axis, to.axis, to.arcs}.at(time);
      const ToolPose right = pose(now);
      most = std::max(
          {most, (axis.trocar - right.axis.trocar).norm(), (axis.tip - right.axis.tip).norm()});
      for (std::size_t link = 0; link < 2; ++link) {
        const RigidMotion motion(from.links[link], to.links[link],
                                 to.joints.empty() ? ChainMotion{} : to.joints[link]);
        const Isometry3d found = motion.at(time);
        for (const LinkPart& part : tool.links[link].parts) {
          for (const double side : {-1.0, 1.0}) {
            const Vector3d point = part.bounds.center +
                                   part.bounds.axes * (side * part.bounds.half_size) +
                                   side * part.radius * Vector3d::UnitY();
            most = std::max(most, (found * point - right.links[link] * point).norm());
          }
        }
      }
    }
    return most;
  }

  double end;  ///< [s]
  Tool tool;
  TransformBuffer buffer;
};

using Touched = std::set<std::pair<std::uint32_t, std::int32_t>>;

Touched touched(const CollisionResult& result) {
  Touched found;
  for (const FaceContact& contact : result.contacts) found.insert({contact.face, contact.link});
  return found;
}

}  // namespace

TEST(TurningTools, APathIsWhatTfInterpolates) {
  Random random(31);
  for (int i = 0; i < 400; ++i) {
    TurningScene scene(i % 2 == 0 ? 3.1415 : random.scale(1e-4, 3.1415), random);
    const SampledPath sampled = scene.path();
    ASSERT_EQ(sampled.unknown, "") << "scene " << i;
    ASSERT_LE(scene.deviation(sampled.path), kExactWay) << "scene " << i;
  }
}

TEST(TurningTools, ConstantRatesAreOneLegAndMoreLegsThanMayBeAreTold) {
  Random random(32);
  for (int i = 0; i < 20; ++i) {
    TurningScene scene(3.0, random);
    TransformBuffer& buffer = scene.buffer;
    buffer.clear();
    for (int k = -1; k < 12; ++k) {
      const double time = kStartTime + 0.1 * k * (scene.end - kStartTime);
      const auto turned = [&](double angle) {
        return Isometry3d(Eigen::Translation3d(0.1, 0.2, 0.3 + 0.01 * k) *
                          Eigen::AngleAxisd(angle * k, Vector3d(0.6, 0.0, 0.8)));
      };
      for (const char* frame : {"joint0", "base0"})
        set_transform(buffer, "world", frame, time, turned(0.2));
      for (int joint = 1; joint < 4; ++joint) {
        const std::string parent = TurningScene::frame(joint - 1);
        set_transform(buffer, parent + (joint % 2 == 0 ? "" : "_mount"), TurningScene::frame(joint),
                      time, turned(0.05));
      }
      set_transform(buffer, "base0", "base1", time, turned(0.05));
      set_transform(buffer, "arm/wrist", "arm/jaw", time, turned(0.05));
    }
    const SampledPath sampled = scene.path();
    EXPECT_EQ(sampled.unknown, "");
    EXPECT_EQ(sampled.path.size(), 2U);
    EXPECT_LE(scene.deviation(sampled.path), kExactWay);
  }
  std::size_t told = 0;
  for (int i = 0; i < 50; ++i) {
    TurningScene scene(random.scale(1e-5, 3.0), random);
    const SampledPath sampled = scene.path(2);
    ASSERT_LE(sampled.path.size(), 3U) << "never more than motion_samples_max legs";
    const bool is_told = sampled.unknown.find("motion_samples_max") != std::string::npos;
    EXPECT_TRUE(is_told || scene.deviation(sampled.path) <= kExactWay) << "scene " << i;
    told += is_told;
  }
  EXPECT_GT(told, 10U);
}

// Half a turn between two stamps has no direction, except that of TF.
TEST(TurningTools, HalfATurnGoesTheWayOfTf) {
  Random random(34);
  for (int i = 0; i < 100; ++i) {
    TurningScene scene(M_PI, random);
    const SampledPath sampled = scene.path();
    EXPECT_EQ(sampled.unknown, "");
    ASSERT_LE(scene.deviation(sampled.path), kExactWay) << "scene " << i;
  }
}

// A frame that gets another parent jumps on TF. Before and afterwards, its path is as exact.
TEST(TurningTools, AFrameMayChangeItsParent) {
  Random random(35);
  TurningScene scene(1.0, random, true);
  TransformBuffer& buffer = scene.buffer;
  for (int hand = 0; hand < 2; ++hand) {
    for (const double time : {0.0, 0.5, 1.0}) {
      const double stamp = scene.end + 2.0 + hand + time;
      const std::string parent = "hand" + std::to_string(hand);
      set_transform(buffer, "world", parent, stamp,
                    Isometry3d(Eigen::AngleAxisd(2.0 * time, Vector3d::UnitX())));
      if (time < 1.0 || hand == 1) {
        set_transform(buffer, parent, scene.tool.parameters.tip_frame, stamp,
                      Isometry3d(Eigen::Translation3d(0.2, 0.1, 0.0) *
                                 Eigen::AngleAxisd(-2.0 * time, Vector3d::UnitY())));
      }
    }
  }
  const ToolPoses poses(buffer, {0.001, 100});
  Tool tool = shaft_tool("hook", kTipRadius);
  tool.parameters.tip_frame = scene.tool.parameters.tip_frame;
  tool.parameters.trocar_frame = "liver";
  tool.parameters.tip_offset = {0.05, 0.0, 0.1};
  for (int hand = 0; hand < 2; ++hand) {
    const ros::Time from(scene.end + 2.0 + hand), to(scene.end + 2.5 + hand);
    const auto known = [&](ros::Time time) { return *poses.pose(tool, "liver", time).found; };
    const SampledPath sampled = poses.path(tool, "liver", known(from), known(to));
    ASSERT_EQ(sampled.path.size(), 2U);
    for (int i = 0; i <= 50; ++i) {
      const ShaftAxis found =
          ShaftMotion{sampled.path[0].axis, sampled.path[1].axis, sampled.path[1].arcs}.at(0.02 *
                                                                                           i);
      EXPECT_LE((found.tip - known(from + ros::Duration(0.01 * i)).value.axis.tip).norm(),
                kExactWay);
    }
  }
}

// Poses along the way are tested one by one. What each of them touches, the step touches.
TEST(TurningTools, EveryFaceThatTheWayTouchesIsFoundAndNoOther) {
  Random random(33);
  CollisionQuery query{PickerSettings{PickerKind::kCpu}};
  CollisionResult result;
  std::size_t count = 0, by_joints_alone = 0;
  for (int i = 0; i < 120; ++i) {
    TurningScene scene(2.0, random, i % 2 == 0);
    const TriangleMesh organ = mesh(scattered_faces(150, random));
    CollisionRequest request = swept(organ, scene.path().path, kTipRadius);
    request.links = &scene.tool.links;
    query.evaluate(request, result);
    const std::vector<FaceContact> contacts = result.contacts;
    const Touched found = touched(result);
    count += found.size();
    for (ToolWaypoint& waypoint : request.path) {
      waypoint.arcs = {};
      waypoint.joints = {};
    }
    query.evaluate(request, result);
    by_joints_alone += touched(result) != found;

    request.mode = QueryMode::kStatic;
    const auto touched_at = [&](double fraction, double growth) {
      request.path = resting_path(scene.pose(scene.at(fraction)));
      request.radius = kTipRadius + growth;
      std::vector<Link> links = scene.tool.links;
      for (Link& link : links) {
        for (LinkPart& part : link.parts) part.radius = std::max(part.radius + growth, 1e-9);
      }
      request.links = &links;
      query.evaluate(request, result);
      return touched(result);
    };
    for (int k = 0; k <= 100; ++k) {
      for (const auto& touch : touched_at(k / 100.0, -1e-6)) {
        ASSERT_EQ(found.count(touch), 1U) << "scene " << i << ", face " << touch.first;
      }
    }
    for (const FaceContact& contact : contacts) {
      ASSERT_EQ(touched_at(contact.fraction, 1e-5).count({contact.face, contact.link}), 1U)
          << "scene " << i << ", face " << contact.face << ", link " << contact.link;
    }
  }
  EXPECT_GT(count, 500U);
  EXPECT_GT(by_joints_alone, 10U) << "joints must matter";
}

}  // namespace organ_collision
