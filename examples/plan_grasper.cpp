// Plans how the grasper of plan.launch gets from the front of the liver to its hilum without
// touching it, and lets it go there. plan_grasper.py does the same.
#include <organ_collision/QueryCollisionBatch.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>

#include "grasper_kinematics.hpp"
#include "rrt_connect.hpp"

namespace {

using grasper::Joints;
using organ_collision::ContactArray;
using organ_collision::LinkMotion;
using organ_collision::QueryCollisionBatch;
using rrt_connect::Path;
using rrt_connect::Place;

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
constexpr int kGoals = 5, kSamples = 1000, kShortcuts = 100;
constexpr double kSpeed = 0.03, kRate = 100.0;  // [m/s], [Hz] of the grasper on its way

/// In the liver's frame: below the liver and in front of it. Its z axis points at the liver's
/// middle.
Eigen::Isometry3d trocar() {
  const Eigen::Quaterniond rotation(0.0894354727, -0.0413637326, -0.9032105840, -0.4177331430);
  return Eigen::Translation3d(0.02, -0.12, 0.10) * rotation.normalized();
}

/// [m per rad, or 1] About how far the tip goes if a joint moves. Places of the planner are joints
/// times these, in metres.
const Joints kReach = (Joints() << 0.15, 0.15, 1.0, 0.02, 0.03, 0.03).finished();

Joints joints_at(const Place& place) { return place.cwiseQuotient(kReach); }
Place place_of(const Joints& joints) { return joints.cwiseProduct(kReach); }

/// The places on the way from a to b, with both.
Path straight(const Place& a, const Place& b, double piece) {
  const int count = std::max(1, static_cast<int>(std::ceil((b - a).norm() / piece)));
  Path places;
  for (int i = 0; i < count; ++i) places.push_back(a + (b - a) * i / count);
  places.push_back(b);
  return places;
}

/// The places on the whole path.
Path straight(const Path& path, double piece) {
  Path places{path.front()};
  for (std::size_t leg = 1; leg < path.size(); ++leg) {
    const Path of_leg = straight(path[leg - 1], path[leg], piece);
    places.insert(places.end(), of_leg.begin() + 1, of_leg.end());
  }
  return places;
}

/// Asks the collision node what the grasper would touch.
class Tissue {
 public:
  Tissue() {
    ros::service::waitForService(kService);
    client_ = ros::NodeHandle().serviceClient<QueryCollisionBatch>(kService, true);
  }

  /// How many motions from place to place are free, one after the other. If all are, and if
  /// `distance` is not null, it gets the smallest distance from the tissue [m].
  std::size_t free_motions(const Path& places, double* distance = nullptr) {
    QueryCollisionBatch call;
    call.request.header.frame_id = call.request.organ = "liver";
    call.request.tool = "grasper";
    call.request.mode = ContactArray::SWEPT;
    call.request.stop_at_first_contact = true;
    call.request.clearance = distance != nullptr;
    for (std::size_t i = 1; i < places.size(); ++i) {
      LinkMotion motion;
      motion.previous = links(places[i - 1]);
      motion.links = links(places[i]);
      call.request.link_motions.push_back(motion);
    }
    if (!client_.call(call)) throw std::runtime_error("the collision node does not answer");
    if (call.response.status != ContactArray::OK) throw std::runtime_error(call.response.message);
    const std::vector<ContactArray>& answers = call.response.results;
    if (distance) {
      for (const auto& answer : answers) *distance = std::min(*distance, answer.clearance.least);
    }
    return std::count_if(answers.begin(), answers.end(), [](const ContactArray& answer) {
      return answer.status == ContactArray::OK && answer.contacts.empty();
    });
  }

 private:
  static constexpr char kService[] = "/organ_collision/query_batch";

  static std::vector<geometry_msgs::Pose> links(const Place& place) {
    std::vector<geometry_msgs::Pose> poses;
    for (const auto& pose : grasper::link_poses(trocar(), joints_at(place))) {
      poses.push_back(tf2::toMsg(pose));
    }
    return poses;
  }

  ros::ServiceClient client_;
};

/// Places where the tip is at the target and nothing is touched.
Path free_goals(Tissue& tissue, const Eigen::Vector3d& target, std::mt19937& random) {
  std::uniform_real_distribution<double> roll(grasper::lowest()[3], grasper::highest()[3]);
  std::uniform_real_distribution<double> wrist(grasper::lowest()[4], grasper::highest()[4]);
  Path goals;
  while (goals.size() < kGoals && ros::ok()) {
    const double rolled = roll(random);
    const auto joints = grasper::joints_for(trocar(), target, rolled, wrist(random), kJaw);
    if (!joints) continue;
    const Place goal = place_of(*joints);
    if (tissue.free_motions({goal, goal}) == 1) goals.push_back(goal);
  }
  return goals;
}

Place random_place(std::mt19937& random) {
  Joints joints;
  for (int i = 0; i < joints.size(); ++i) {
    joints[i] = std::uniform_real_distribution(grasper::lowest()[i], grasper::highest()[i])(random);
  }
  joints[5] = kJaw;
  return place_of(joints);
}

/// A path to the target that touches nothing. Throws std::runtime_error if there is none.
Path plan(Tissue& tissue, const Eigen::Vector3d& target, std::mt19937& random) {
  const auto start = grasper::joints_for(trocar(), kStart, 0.0, 0.0, kJaw);
  const auto advance = [&](const Place& a, const Place& b) {
    const Path places = straight(a, b, kPiece);
    return places[tissue.free_motions(places)];
  };
  Path path = rrt_connect::connect(
      place_of(start.value()), free_goals(tissue, target, random), advance,
      [&] { return random_place(random); }, kSamples);
  if (path.empty()) throw std::runtime_error("no way was found");
  return rrt_connect::shortened(path, advance, random, kShortcuts);
}

/// Checks the path with finer motions. Returns its distance from the tissue [m]. Throws
/// std::runtime_error if it touches.
double checked_distance(Tissue& tissue, const Path& path) {
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t leg = 1; leg < path.size(); ++leg) {
    const Path places = straight(path[leg - 1], path[leg], kFinePiece);
    if (tissue.free_motions(places, &distance) == places.size() - 1) continue;
    throw std::runtime_error("finer motions touch the tissue");
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
    line.points.push_back(tf2::toMsg(grasper::tip(trocar(), joints_at(place))));
  }
  visualization_msgs::MarkerArray array;
  array.markers.push_back(line);
  return array;
}

/// The grasper goes along the path and stays at its end.
void play(const Path& path, ros::Publisher& joint_states) {
  sensor_msgs::JointState message;
  message.name.assign(grasper::kJoints.begin(), grasper::kJoints.end());
  const Path way = straight(path, kSpeed / kRate);
  ros::Rate rate(kRate);
  for (std::size_t step = 0; ros::ok(); rate.sleep()) {
    const Joints joints = joints_at(way[step]);
    message.header.stamp = ros::Time::now();
    message.position.assign(joints.data(), joints.data() + joints.size());
    joint_states.publish(message);
    if (step + 1 < way.size()) ++step;
  }
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
  auto joint_states = node.advertise<sensor_msgs::JointState>("joint_states", 10);
  auto markers =
      node.advertise<visualization_msgs::MarkerArray>("/organ_collision/markers", 1, true);
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(trocar_transform());
  const auto target = private_node.param("target", kTarget);
  std::mt19937 random(private_node.param("seed", 0));
  try {
    Tissue tissue;
    const Path path =
        plan(tissue, Eigen::Vector3d(target.at(0), target.at(1), target.at(2)), random);
    ROS_INFO("%zu legs, at least %.1f mm from the liver", path.size() - 1,
             1e3 * checked_distance(tissue, path));
    markers.publish(line_of(path));
    play(path, joint_states);
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
