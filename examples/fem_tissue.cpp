/// An example of a simulator in which the vertex forces of haptic_proxy alone move the tissue. The
/// proxy is in lockstep, and runs as a nodelet in this process, so that the shapes reach it without
/// a copy.

#include <geometry_msgs/WrenchStamped.h>
#include <nodelet/loader.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/VertexForces.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <boost/make_shared.hpp>
#include <cmath>

#include "common/messages/conversions.hpp"
#include "common/program/program.hpp"
#include "fem_block.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

constexpr char kProgram[] = "fem_tissue";
constexpr char kOrgan[] = "tissue";  // the name and the frame of the organ
constexpr char kProxyNode[] = "/haptic_proxy";
constexpr char kForces[] = "vertex_forces";
constexpr char kImpulse[] = "impulse";
constexpr double kStep = 0.004;     // [s]
constexpr double kPeriod = 4.0;     // [s] the probe presses once in this time
constexpr double kHighest = 0.012;  // [m] the tip's highest z; the tissue at rest ends at z = 0
constexpr double kLowest = -0.008;  // [m] the tip's lowest z
const ros::WallDuration kTfLead(0.5);
const ros::WallDuration kPatience(0.1);  // after it, the shape is sent again with a new stamp

ProgramHelp help() {
  ProgramHelp help{kProgram,
                   "An example of a simulator: a probe presses into a block of soft tissue, which "
                   "Bullet simulates with finite elements. The vertex forces of haptic_proxy "
                   "alone move it. Runs haptic_proxy as a nodelet in its own process."};
  help.subscribed = {{kForces, "organ_collision/VertexForces", "what moves the tissue"}};
  help.published = {{ros::names::append(kProxyNode, names::kOrganMesh), "organ_collision/OrganMesh",
                     "the tissue, once"},
                    {ros::names::append(kProxyNode, names::kOrganVertices),
                     "organ_collision/OrganVertices", "its new shapes"},
                    {"/tf", "tf2_msgs/TFMessage", "tip and trocar of the probe"},
                    {"~impulse", "geometry_msgs/WrenchStamped",
                     "what the nodes of the finite elements were given in a step [N s], [N m s]"}};
  help.further = "roslaunch organ_collision fem_tissue.launch starts it.";
  return help;
}

geometry_msgs::TransformStamped frame(const std::string& name, const ros::Time& stamp,
                                      const Eigen::Vector3d& place) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = kOrgan;
  transform.child_frame_id = name;
  transform.transform.translation = to_vector(place);
  transform.transform.rotation.w = 1.0;
  return transform;
}

class FemTissue {
 public:
  explicit FemTissue(ros::NodeHandle node)
      : mesh_publisher_(proxy_node_.advertise<OrganMesh>(names::kOrganMesh, 1, true)),
        vertices_publisher_(proxy_node_.advertise<OrganVertices>(names::kOrganVertices, 1)),
        impulse_publisher_(
            ros::NodeHandle("~").advertise<geometry_msgs::WrenchStamped>(kImpulse, 100)),
        forces_subscriber_(node.subscribe<VertexForces>(
            kForces, 10, [this](const VertexForcesConstPtr& forces) { forces_ = forces; },
            ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay())) {}

  /// Sends poses of the probe for a while, so that they are known before the first shape, and then
  /// the tissue at rest.
  void begin() {
    const ros::WallTime start = ros::WallTime::now();
    while (ros::ok() && ros::WallTime::now() - start < kTfLead) {
      publish_probe(ros::Time::now());
      ros::WallDuration(kStep).sleep();
    }
    const ros::Time stamp = ros::Time::now();
    publish_probe(stamp);
    publish_mesh(stamp);
  }

  /// One step: sends the shape, waits for the forces on it, applies them. Without forces the tissue
  /// does not move, because a missing answer is not the same as no contact.
  void step() {
    const ros::Time stamp = ros::Time::now();
    publish_probe(stamp);
    vertices_publisher_.publish(shape<OrganVertices>(stamp));
    if (!wait_for_forces(stamp)) return;
    apply_forces();
    block_.step(kStep);
    ++steps_;
  }

 private:
  template <typename Message>
  boost::shared_ptr<Message> shape(const ros::Time& stamp) const {
    auto message = boost::make_shared<Message>();
    message->header.stamp = stamp;
    message->header.frame_id = message->organ = kOrgan;
    message->vertices = block_.vertices();
    return message;
  }

  void publish_mesh(const ros::Time& stamp) {
    const auto mesh = shape<OrganMesh>(stamp);
    for (const FaceIndices& face : block_.faces()) {
      mesh->triangles.insert(mesh->triangles.end(), face.begin(), face.end());
    }
    mesh_publisher_.publish(mesh);
  }

  /// The probe leans a little. It presses into the middle of the tissue and moves up again in turn.
  void publish_probe(const ros::Time& stamp) {
    const double share = 0.5 - 0.5 * std::cos(2.0 * M_PI * steps_ * kStep / kPeriod);
    const Eigen::Vector3d tip(0.0031, -0.0017, kHighest + share * (kLowest - kHighest));
    frames_.sendTransform({frame("probe_trocar", stamp, tip + Eigen::Vector3d(0.02, 0.01, 0.15)),
                           frame("probe_tip", stamp, tip)});
  }

  bool wait_for_forces(const ros::Time& stamp) {
    const ros::WallTime start = ros::WallTime::now();
    while (ros::ok() && ros::WallTime::now() - start < kPatience) {
      if (forces_ && forces_->mesh_stamp == stamp) return true;
      ros::getGlobalCallbackQueue()->callOne(ros::WallDuration(0.01));
    }
    return false;
  }

  void apply_forces() {
    FemBlock::Impulse sum;
    for (std::size_t i = 0; i < forces_->vertices.size(); ++i) {
      const FemBlock::Impulse given =
          block_.push(forces_->vertices[i], to_eigen(forces_->forces.at(i)), kStep);
      sum.linear += given.linear;
      sum.angular += given.angular;
    }
    geometry_msgs::WrenchStamped message;
    message.header = forces_->header;
    message.header.stamp = forces_->mesh_stamp;
    message.wrench.force = to_vector(sum.linear);
    message.wrench.torque = to_vector(sum.angular);
    impulse_publisher_.publish(message);
  }

  FemBlock block_;
  long steps_ = 0;
  VertexForcesConstPtr forces_;
  tf2_ros::TransformBroadcaster frames_;
  ros::NodeHandle proxy_node_{kProxyNode};
  ros::Publisher mesh_publisher_;
  ros::Publisher vertices_publisher_;
  ros::Publisher impulse_publisher_;
  ros::Subscriber forces_subscriber_;
};

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  if (const auto exit_code = answer_arguments(argc, argv, help())) return *exit_code;
  ros::init(argc, argv, kProgram);
  const ros::NodeHandle node;
  nodelet::Loader proxy_node(false);
  if (!proxy_node.load(kProxyNode, "organ_collision/HapticProxyNodelet", {}, {})) return 1;
  FemTissue tissue(node);
  tissue.begin();
  for (ros::WallRate rate(1.0 / kStep); ros::ok(); rate.sleep()) tissue.step();
}
