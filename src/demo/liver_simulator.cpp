/// The demo's simulator. Publishes a breathing liver and two instruments for the collision node.
/// The contacts in the node's answers push the tissue.

#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/ros.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "liver_soft_body.hpp"
#include "organ_collision/ros/names.hpp"
#include "ros/interface/program_help.hpp"
#include "scripted_tools.hpp"

namespace organ_collision {
namespace {

constexpr char kOrgan[] = "liver";    // its name and its frame
constexpr double kYield = 0.5;        // [1] share of the depth by which tissue yields in one step
constexpr double kMostYield = 0.008;  // [m] in one step
constexpr double kTfLeadSec =
    0.5;  // only TF is sent, so that listeners have it before the first shape
constexpr double kRate = 125.0;  // [Hz] of shapes, by default
constexpr char kCollisionNode[] = "/organ_collision";

ProgramHelp help() {
  ProgramHelp help{"liver_simulator",
                   "The demo's simulator: a breathing liver and two instruments, for a collision "
                   "node whose contacts push the tissue. Names of topics are below that node's."};
  help.subscribed = {{names::kContacts, "organ_collision/ContactArray", "what pushes the tissue"}};
  help.published = {{names::kOrganMesh, "organ_collision/OrganMesh", "the liver, once"},
                    {names::kOrganVertices, "organ_collision/OrganVertices", "its new shapes"},
                    {"/tf, /tf_static", "tf2_msgs/TFMessage", "tips and trocars"}};
  help.parameters = {{names::kRate, shown(kRate), "[Hz] of shapes"},
                     {"collision_node", kCollisionNode, "name of the collision node"}};
  help.further = "roslaunch organ_collision demo.launch starts it.";
  return help;
}

geometry_msgs::TransformStamped transform(const ros::Time& stamp, const std::string& parent,
                                          const std::string& child,
                                          const Eigen::Vector3d& translation,
                                          const Eigen::Quaterniond& rotation) {
  geometry_msgs::TransformStamped result;
  result.header.stamp = stamp;
  result.header.frame_id = parent;
  result.child_frame_id = child;
  tf2::toMsg(translation, result.transform.translation);
  result.transform.rotation = tf2::toMsg(rotation);
  return result;
}

/// How a tool's contacts push the tissue.
std::vector<TissuePush> pushes_of(const std::vector<Contact>& contacts) {
  std::vector<TissuePush> pushes;
  for (const Contact& contact : contacts) {
    const Eigen::Vector3d normal(contact.normal.x, contact.normal.y, contact.normal.z);
    const double way = std::clamp(kYield * contact.depth, 0.0, kMostYield);
    pushes.push_back({contact.face, Eigen::Vector3d(contact.barycentric.data()), way * normal});
  }
  return pushes;
}

class LiverSimulator {
 public:
  LiverSimulator(ros::NodeHandle collision_node, double rate)
      : rate_(rate),
        surface_(make_liver_surface()),
        liver_(surface_),
        mesh_publisher_(collision_node.advertise<OrganMesh>("organ_mesh", 1, true)),
        vertices_publisher_(collision_node.advertise<OrganVertices>("organ_vertices", 1)),
        contacts_subscriber_(
            collision_node.subscribe("contacts", 10, &LiverSimulator::on_contacts, this)) {
    publish_trocars();
  }

  /// Begins with the tools alone, so that their frames are known before the first shape.
  void step() {
    if (lead_steps_ < kTfLeadSec * rate_) {
      ++lead_steps_;
      publish_tips(ros::Time::now());
    } else {
      step_liver();
    }
  }

 private:
  /// Simulates one period. Publishes the tools' poses before the shape, with the same stamp.
  void step_liver() {
    std::vector<TissuePush> pushes;
    for (const auto& [tool, tool_pushes] : pushes_) {
      pushes.insert(pushes.end(), tool_pushes.begin(), tool_pushes.end());
    }
    pushes_.clear();
    if (++steps_ > 1) liver_.step(1.0 / rate_, pushes);
    const ros::Time stamp = ros::Time::now();
    publish_tips(stamp);
    steps_ == 1 ? publish_mesh(stamp) : publish_vertices(stamp);
  }

  void on_contacts(const ContactArray& array) {
    if (array.status == ContactArray::OK && array.organ == kOrgan) {
      pushes_[array.tool] = pushes_of(array.contacts);
    }
  }

  void publish_trocars() {
    std::vector<geometry_msgs::TransformStamped> trocars;
    for (const ScriptedTool& tool : scripted_tools()) {
      trocars.push_back(transform(ros::Time::now(), kOrgan, tool.name + "_trocar", tool.trocar,
                                  Eigen::Quaterniond::Identity()));
    }
    trocar_broadcaster_.sendTransform(trocars);
  }

  void publish_mesh(const ros::Time& stamp) {
    OrganMesh mesh;
    mesh.header.stamp = stamp;
    mesh.header.frame_id = kOrgan;
    mesh.organ = kOrgan;
    mesh.vertices = liver_.vertices();
    for (const FaceIndices& face : surface_.faces) {
      mesh.triangles.insert(mesh.triangles.end(), face.begin(), face.end());
    }
    mesh_publisher_.publish(mesh);
  }

  /// The z axis of a tip's frame points along the shaft.
  void publish_tips(const ros::Time& stamp) {
    std::vector<geometry_msgs::TransformStamped> tips;
    for (const ScriptedTool& tool : scripted_tools()) {
      const Eigen::Vector3d shaft = tool.tip(steps_ / rate_) - tool.trocar;
      tips.push_back(
          transform(stamp, tool.name + "_trocar", tool.name + "_tip", shaft,
                    Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), shaft)));
    }
    tip_broadcaster_.sendTransform(tips);
  }

  void publish_vertices(const ros::Time& stamp) {
    OrganVertices vertices;
    vertices.header.stamp = stamp;
    vertices.header.frame_id = kOrgan;
    vertices.organ = kOrgan;
    vertices.vertices = liver_.vertices();
    vertices_publisher_.publish(vertices);
  }

  double rate_;
  ClosedSurface surface_;
  LiverSoftBody liver_;
  std::map<std::string, std::vector<TissuePush>> pushes_;  ///< by tool, since the last step
  long lead_steps_ = 0;
  long steps_ = 0;
  ros::Publisher mesh_publisher_;
  ros::Publisher vertices_publisher_;
  ros::Subscriber contacts_subscriber_;
  tf2_ros::StaticTransformBroadcaster trocar_broadcaster_;
  tf2_ros::TransformBroadcaster tip_broadcaster_;
};

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  if (const auto exit_code = answer_arguments(argc, argv, help())) return *exit_code;
  ros::init(argc, argv, "liver_simulator");
  ros::NodeHandle private_node("~");
  const double rate = private_node.param<double>(names::kRate, kRate);
  const double fastest = 1.0 / kStabDuration;
  if (!(rate >= 20.0 && rate <= fastest)) {
    ROS_FATAL("rate is %g; it must be from 20 to %g Hz, so that a stab fits into one step", rate,
              fastest);
    return 2;
  }
  const std::string collision_node =
      private_node.param<std::string>("collision_node", kCollisionNode);
  if (!ros::service::waitForService(ros::names::append(collision_node, "query"))) return 1;
  LiverSimulator simulator(ros::NodeHandle(collision_node), rate);
  for (ros::Rate loop(rate); ros::ok(); loop.sleep()) {
    ros::spinOnce();
    simulator.step();
  }
}
