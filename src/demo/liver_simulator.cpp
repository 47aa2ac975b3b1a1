/// The demo's simulator. Publishes a breathing liver and two instruments. The contacts of the
/// collision node push the tissue, and so do the forces of the proxy of the instrument that a hand
/// holds.

#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/VertexForces.h>
#include <ros/ros.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "common/messages/conversions.hpp"
#include "common/program/program.hpp"
#include "geometry/concatenate.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "liver.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

constexpr char kOrgan[] = "liver";    // the name and the frame of the organ
constexpr double kYield = 0.5;        // [1] share of the depth by which tissue yields in one step
constexpr double kMostYield = 0.008;  // [m] the most that tissue yields in one step
/// [m/N] How far a vertex yields in one step for each newton of the force of a proxy.
constexpr double kCompliance = 1e-3;
/// [s] At first, no shape is sent for this long, so that listeners have TF before the first shape.
constexpr double kTfLeadSec = 0.5;
constexpr double kRate = 125.0;  // [Hz] how often a shape is sent, by default
/// [s] After this stab, the stabber has cut off the end of the lobe.
constexpr double kCutTime = 8.0;
constexpr int kHandPoses = 8;  // poses of the hand for each shape: 1 kHz by default
constexpr char kCollisionNode[] = "/organ_collision";
constexpr char kHapticNode[] = "/haptic_proxy";

ProgramHelp help() {
  const std::string below_haptic_node = std::string(kHapticNode) + "/liver/palpator/vertex_forces";
  ProgramHelp help{"liver_simulator",
                   "The demo's simulator: a breathing liver, and two instruments that push the "
                   "tissue. A hand holds one of them, the palpator. Names of topics are below the "
                   "collision node's, unless they begin with /."};
  help.subscribed = {{names::kContacts, "organ_collision/ContactArray", "what pushes the tissue"},
                     {below_haptic_node, "organ_collision/VertexForces",
                      "how the proxy of the palpator pushes it"}};
  help.published = {{names::kOrganMesh, "organ_collision/OrganMesh",
                     "the liver, and after 8 s what the stabber leaves of it"},
                    {names::kOrganVertices, "organ_collision/OrganVertices", "its new shapes"},
                    {"/palpator/hand", "geometry_msgs/PoseStamped", "the hand, 8 for each shape"},
                    {"/tf, /tf_static", "tf2_msgs/TFMessage", "trocars, and the stabber's tip"}};
  help.parameters = {{"rate", concatenate(kRate), "[Hz] of shapes"},
                     {"moves", "true", "false: the liver rests, and no instrument moves"},
                     {"collision_node", kCollisionNode, "name of the collision node"},
                     {"haptic_node", kHapticNode, "name of the node that has the proxies"}};
  help.further = "roslaunch organ_collision demo.launch starts it.";
  return help;
}

/// How a tool's contacts push the tissue: each place yields along the contact's normal. The weights
/// of the vertices are chosen so that the place moves by exactly this way.
std::vector<VertexPush> pushes_of(const std::vector<Contact>& contacts) {
  std::vector<VertexPush> pushes;
  for (const Contact& contact : contacts) {
    const double way = std::clamp(kYield * contact.depth, 0.0, kMostYield);
    const Eigen::Vector3d shares(contact.barycentric.data());
    for (int k = 0; k < 3; ++k) {
      pushes.push_back(
          {contact.vertices[k], shares[k] / shares.squaredNorm() * way * to_eigen(contact.normal)});
    }
  }
  return pushes;
}

/// How the forces of a proxy push the tissue.
std::vector<VertexPush> pushes_of(const VertexForces& forces) {
  std::vector<VertexPush> pushes;
  for (std::size_t i = 0; i < forces.vertices.size(); ++i) {
    pushes.push_back({forces.vertices[i], kCompliance * to_eigen(forces.forces[i])});
  }
  return pushes;
}

/// A pose whose z axis points along the shaft.
Eigen::Isometry3d pose_at(const Eigen::Vector3d& place, const Eigen::Vector3d& shaft) {
  Eigen::Isometry3d pose(Eigen::Translation3d{place});
  pose.rotate(least_rotation(Eigen::Vector3d::UnitZ(), shaft));
  return pose;
}

geometry_msgs::TransformStamped transform(const ros::Time& stamp, const std::string& parent,
                                          const std::string& child,
                                          const Eigen::Isometry3d& T_parent_child) {
  geometry_msgs::TransformStamped result = tf2::eigenToTransform(T_parent_child);
  result.header.stamp = stamp;
  result.header.frame_id = parent;
  result.child_frame_id = child;
  return result;
}

class LiverSimulator {
 public:
  /// `rate` [Hz] of shapes.
  LiverSimulator(ros::NodeHandle node, ros::NodeHandle collision_node, ros::NodeHandle haptic_node,
                 double rate)
      : rate_(rate),
        liver_(make_liver_surface()),
        mesh_publisher_(collision_node.advertise<OrganMesh>(names::kOrganMesh, 1, true)),
        vertices_publisher_(collision_node.advertise<OrganVertices>(names::kOrganVertices, 1)),
        hand_publisher_(node.advertise<geometry_msgs::PoseStamped>(kPalpator.name + "/hand", 1)),
        contacts_subscriber_(
            collision_node.subscribe(names::kContacts, 10, &LiverSimulator::on_contacts, this)),
        forces_subscriber_(
            haptic_node.subscribe(std::string(kOrgan) + "/" + kPalpator.name + "/vertex_forces", 10,
                                  &LiverSimulator::on_forces, this)) {
    std::vector<geometry_msgs::TransformStamped> trocars;
    for (const ScriptedTool& tool : {kPalpator, kStabber}) {
      trocars.push_back(transform(ros::Time::now(), kOrgan, tool.name + "_trocar",
                                  Eigen::Isometry3d(Eigen::Translation3d(tool.trocar))));
    }
    trocar_broadcaster_.sendTransform(trocars);
  }

  /// Call this kHandPoses times for each shape: the hand moves at each call. The first calls send
  /// only the tools, so that their frames are known before the first shape.
  void step() {
    const long part = calls_++ % kHandPoses;
    if (part == 0 && lead_steps_ < kTfLeadSec * rate_) {
      ++lead_steps_;
      send_stabber(0.0, ros::Time::now());
    } else if (part == 0) {
      step_liver();
    }
    const double steps = steps_ + static_cast<double>(part) / kHandPoses;
    send_hand(steps_ > 0 ? steps / rate_ : 0.0, ros::Time::now());
  }

  /// Publishes the liver with its triangles. If step() was never called, the liver is at rest.
  void publish_mesh(const ros::Time& stamp) {
    auto mesh = shape<OrganMesh>(stamp);
    for (const FaceIndices& face : liver_.surface().faces) {
      mesh.triangles.insert(mesh.triangles.end(), face.begin(), face.end());
    }
    mesh_publisher_.publish(mesh);
  }

 private:
  /// Simulates one period. Publishes the stabber's pose before the shape, with the same stamp.
  void step_liver() {
    std::vector<VertexPush> pushes;
    for (const auto& [sender, its] : pushes_) pushes.insert(pushes.end(), its.begin(), its.end());
    pushes_.clear();
    if (++steps_ > 1) liver_.step(1.0 / rate_, pushes);
    const ros::Time stamp = ros::Time::now();
    const double seconds = steps_ / rate_;
    send_stabber(seconds, stamp);
    const bool is_cut = topology_ == 0 && seconds > kCutTime + kStabDuration;
    if (is_cut) cut_lobe();
    if (steps_ == 1 || is_cut) return publish_mesh(stamp);
    vertices_publisher_.publish(shape<OrganVertices>(stamp));
  }

  /// Cuts off the lobe's end: what is beyond the plane in which the stabber moved.
  void cut_lobe() {
    const Eigen::Vector3d before = kStabber.tip(kCutTime),
                          after = kStabber.tip(kCutTime + kStabDuration);
    auto plane = Eigen::Hyperplane<double, 3>::Through(kStabber.trocar, before, after);
    if (plane.normal().x() < 0.0) plane.coeffs() *= -1.0;
    liver_.cut(plane);
    ++topology_;
  }

  /// Sends the stabber's tip at `seconds` since the start.
  void send_stabber(double seconds, const ros::Time& stamp) {
    const Eigen::Vector3d shaft = kStabber.tip(seconds) - kStabber.trocar;
    tip_broadcaster_.sendTransform(
        transform(stamp, kStabber.name + "_trocar", kStabber.name + "_tip", pose_at(shaft, shaft)));
  }

  /// Publishes the hand's pose at `seconds` since the start, as a haptic device's driver does.
  void send_hand(double seconds, const ros::Time& stamp) {
    const Eigen::Vector3d tip = kPalpator.tip(seconds);
    geometry_msgs::PoseStamped hand;
    hand.header.stamp = stamp;
    hand.header.frame_id = kOrgan;
    hand.pose = tf2::toMsg(pose_at(tip, tip - kPalpator.trocar));
    hand_publisher_.publish(hand);
  }

  void on_contacts(const ContactArray& array) {
    const bool is_ours = array.organ == kOrgan && array.topology == topology_;
    if (array.status == ContactArray::OK && is_ours) {
      pushes_[array.tool] = pushes_of(array.contacts);
    }
  }

  void on_forces(const VertexForces& forces) {
    if (forces.topology == topology_) pushes_["the hand"] = pushes_of(forces);
  }

  template <typename Message>
  Message shape(const ros::Time& stamp) const {
    Message message;
    message.header.stamp = stamp;
    message.header.frame_id = message.organ = kOrgan;
    message.topology = topology_;
    message.vertices = liver_.vertices();
    return message;
  }

  double rate_;
  LiverSoftBody liver_;
  std::map<std::string, std::vector<VertexPush>> pushes_;  ///< by sender; since the last shape
  long calls_ = 0;
  long lead_steps_ = 0;
  long steps_ = 0;
  std::uint32_t topology_ = 0;  ///< 1 after the cut
  tf2_ros::StaticTransformBroadcaster trocar_broadcaster_;
  tf2_ros::TransformBroadcaster tip_broadcaster_;
  ros::Publisher mesh_publisher_;
  ros::Publisher vertices_publisher_;
  ros::Publisher hand_publisher_;
  ros::Subscriber contacts_subscriber_;
  ros::Subscriber forces_subscriber_;
};

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  if (const auto exit_code = answer_arguments(argc, argv, help())) return *exit_code;
  ros::init(argc, argv, "liver_simulator");
  ros::NodeHandle private_node("~");
  const double rate = private_node.param<double>("rate", kRate);
  const double fastest = 1.0 / kStabDuration;
  if (!(rate >= 20.0 && rate <= fastest)) {
    ROS_FATAL("rate is %g; it must be from 20 to %g Hz, so that a stab fits into one step", rate,
              fastest);
    return 2;
  }
  const auto collision_node = private_node.param<std::string>("collision_node", kCollisionNode);
  if (!ros::service::waitForService(ros::names::append(collision_node, "query"))) return 1;
  LiverSimulator simulator{
      ros::NodeHandle(), ros::NodeHandle(collision_node),
      ros::NodeHandle(private_node.param<std::string>("haptic_node", kHapticNode)), rate};
  if (!private_node.param<bool>("moves", true)) {
    simulator.publish_mesh(ros::Time::now());
    ros::spin();
  }
  for (ros::Rate loop(kHandPoses * rate); ros::ok();) {
    ros::spinOnce();
    simulator.step();
    try {
      loop.sleep();
    } catch (const std::runtime_error&) {  // Simulated time has gone on by more than 2^31 s.
      ros::WallDuration(1.0 / (kHandPoses * rate)).sleep();
      loop.reset();
    }
  }
}
