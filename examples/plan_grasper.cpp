// Plans how the grasper of plan.launch gets from the front of the liver to its hilum without
// touching it, and lets it go there. plan_grasper.py does the same.
#include <ros/ros.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <iostream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "grasper_robot.hpp"
#include "grasper_tissue.hpp"

namespace {

using namespace grasper;

constexpr char kUsage[] = R"(Usage: plan_grasper
Takes the grasper of plan.launch from the front of the liver to its hilum without touching it.
Parameters: ~target [m] of the tip, in the frame `liver`; ~seed of the random numbers.
)";

// [m] of the tip, in the liver's frame: in front of the liver, and in the hollow of its underside,
// some millimetres from the surface.
const Eigen::Vector3d kStart(0.0, -0.01, 0.06);
const std::vector<double> kTarget{0.004, -0.004, -0.017};
constexpr double kJaw = 0.1;  // [rad] The jaws stay nearly closed.
// [m] An edge is asked for in pieces of this length, the whole path in finer ones.
constexpr double kPiece = 0.002, kFinePiece = 0.0005;
constexpr double kMargin = 0.02;  // [m] Up to this distance from the tissue the path is measured.
constexpr int kGoals = 5, kSamples = 1000, kShortcuts = 100;
constexpr int kAttempts = 200;   // for each goal, with random roll and wrist
constexpr double kSpeed = 0.03;  // [m/s] of the grasper on its way

/// Up to kGoals places where the tip is at the target and nothing is touched. Throws
/// std::runtime_error if there is none.
Path free_goals(Tissue& tissue, const Eigen::Vector3d& target, std::mt19937& random) {
  std::uniform_real_distribution<double> roll(lowest()[3], highest()[3]);
  std::uniform_real_distribution<double> wrist(lowest()[4], highest()[4]);
  Path goals;
  for (int i = 0; i < kGoals * kAttempts && goals.size() < kGoals; ++i) {
    const double rolled = roll(random);
    const auto joints = joints_for(trocar(), target, rolled, wrist(random), kJaw);
    if (!joints) continue;
    const Place goal = place_of(*joints);
    if (tissue.sweep({goal, goal}).free == 1) goals.push_back(goal);
  }
  if (!goals.empty()) return goals;
  std::ostringstream text;
  text << "the tip cannot be at (" << target.x() << ", " << target.y() << ", " << target.z()
       << ") without touching the liver";
  throw std::runtime_error(text.str());
}

Place random_place(std::mt19937& random) {
  Joints joints;
  for (int i = 0; i < joints.size(); ++i) {
    joints[i] = std::uniform_real_distribution(lowest()[i], highest()[i])(random);
  }
  joints[5] = kJaw;
  return place_of(joints);
}

/// A path to the target that touches nothing. Throws std::runtime_error if there is none.
Path plan(Tissue& tissue, const Place& start, const Eigen::Vector3d& target, std::mt19937& random) {
  const auto advance = [&](const Place& a, const Place& b) {
    const Path places = straight(a, b, kPiece);
    return places[tissue.sweep(places).free];
  };
  Path path = rrt_connect::connect(
      start, free_goals(tissue, target, random), advance, [&] { return random_place(random); },
      kSamples);
  if (path.empty()) throw std::runtime_error("no way was found");
  return rrt_connect::shortened(path, advance, random, kShortcuts);
}

/// Checks the path with finer motions. Returns its distance from the tissue, at most kMargin.
/// Throws std::runtime_error if it touches.
double checked_distance(Tissue& tissue, const Path& path) {
  double distance = kMargin;
  for (std::size_t leg = 1; leg < path.size(); ++leg) {
    const Path places = straight(path[leg - 1], path[leg], kFinePiece);
    const Tissue::Answer answer = tissue.sweep(places, kMargin);
    if (answer.free < places.size() - 1) throw std::runtime_error("finer motions touch the tissue");
    distance = std::min(distance, answer.least);
  }
  return distance;
}

geometry_msgs::TransformStamped trocar_transform() {
  geometry_msgs::TransformStamped transform = tf2::eigenToTransform(trocar());
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = "liver";
  transform.child_frame_id = "grasper_trocar";
  return transform;
}

/// The way of the tip, which RViz shows beside the markers of the collision node.
visualization_msgs::MarkerArray line_of(const Path& path) {
  visualization_msgs::Marker line;
  line.header.frame_id = "liver";
  line.ns = "path";
  line.type = line.LINE_STRIP;
  line.pose.orientation.w = 1.0;
  line.scale.x = 0.001;
  line.color.g = line.color.a = 1.0F;
  for (const Place& place : straight(path, kPiece)) {
    line.points.push_back(tf2::toMsg(tip(trocar(), joints_at(place))));
  }
  visualization_msgs::MarkerArray array;
  array.markers.push_back(line);
  return array;
}

}  // namespace

int main(int argc, char** argv) {
  ros::V_string arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (arguments.size() > 1) {
    std::cout << kUsage;
    return arguments[1] == "--help" || arguments[1] == "-h" ? 0 : 2;
  }
  ros::init(argc, argv, "plan_grasper");
  ros::NodeHandle node, private_node("~");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  auto markers =
      node.advertise<visualization_msgs::MarkerArray>("/organ_collision/markers", 1, true);
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(trocar_transform());
  const std::vector<double> target = private_node.param("target", kTarget);
  std::mt19937 random(private_node.param("seed", 1));
  try {
    const Place start = place_of(joints_for(trocar(), kStart, 0.0, 0.0, kJaw).value());
    Robot robot(start);
    Tissue tissue;
    const Path path =
        plan(tissue, start, Eigen::Vector3d(target.at(0), target.at(1), target.at(2)), random);
    ROS_INFO("%zu legs, at least %.1f mm from the liver", path.size() - 1,
             1e3 * checked_distance(tissue, path));
    robot.follow(straight(path, kSpeed / kRate));
    // Again and again: for each new viewer, the collision node deletes all markers.
    for (; ros::ok(); ros::WallDuration(2.0).sleep()) markers.publish(line_of(path));
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
