/// A simulator beside the collision node: publishes a liver that breathes, and two instruments, and
/// lets the contacts that come back push the tissue.

#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <visualization_msgs/Marker.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "demo/liver_soft_body.hpp"
#include "demo/scripted_tools.hpp"

namespace organ_collision {
namespace {

constexpr char kOrgan[] = "liver";  // its name, and its frame
constexpr double kYield = 0.5;      // [1] share of the depth by which tissue gives way in one step
constexpr double kMostYield = 0.008;  // [m] in one step
constexpr double kMarkerRate = 30.0;  // [Hz]

geometry_msgs::TransformStamped transform(const ros::Time& stamp, const std::string& parent,
                                          const std::string& child,
                                          const Eigen::Vector3d& translation,
                                          const Eigen::Quaterniond& rotation) {
  geometry_msgs::TransformStamped result;
  result.header.stamp = stamp;
  result.header.frame_id = parent;
  result.child_frame_id = child;
  result.transform.translation.x = translation.x();
  result.transform.translation.y = translation.y();
  result.transform.translation.z = translation.z();
  result.transform.rotation.x = rotation.x();
  result.transform.rotation.y = rotation.y();
  result.transform.rotation.z = rotation.z();
  result.transform.rotation.w = rotation.w();
  return result;
}

/// The pushes that a tool's contacts amount to.
std::vector<Push> pushes_of(const std::vector<Contact>& contacts) {
  std::vector<Push> pushes;
  for (const Contact& contact : contacts) {
    const Eigen::Vector3d normal(contact.normal.x, contact.normal.y, contact.normal.z);
    const double way = std::clamp(kYield * contact.depth, 0.0, kMostYield);
    pushes.push_back({contact.face, Eigen::Vector3d(contact.barycentric.data()), way * normal});
  }
  return pushes;
}

class LiverSimulator {
 public:
  LiverSimulator(ros::NodeHandle collision_node, ros::NodeHandle private_node, double rate)
      : rate_(rate),
        surface_(make_liver_surface()),
        liver_(surface_),
        mesh_publisher_(collision_node.advertise<OrganMesh>("organ_mesh", 1, true)),
        vertices_publisher_(collision_node.advertise<OrganVertices>("organ_vertices", 1)),
        marker_publisher_(private_node.advertise<visualization_msgs::Marker>("liver", 1)),
        contacts_subscriber_(
            collision_node.subscribe("contacts", 10, &LiverSimulator::on_contacts, this)) {
    publish_trocars();
    publish_mesh();
  }

  /// Moves on by one period. The tools' poses go out before the shape, with the same stamp.
  void step() {
    std::vector<Push> pushes;
    for (const auto& [tool, tool_pushes] : pushes_) {
      pushes.insert(pushes.end(), tool_pushes.begin(), tool_pushes.end());
    }
    pushes_.clear();
    liver_.step(1.0 / rate_, pushes);
    ++steps_;
    const ros::Time stamp = ros::Time::now();
    publish_tips(stamp);
    publish_vertices(stamp);
    if (steps_ % std::max(1, static_cast<int>(rate_ / kMarkerRate)) == 0) publish_marker(stamp);
  }

 private:
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

  void publish_mesh() {
    OrganMesh mesh;
    mesh.header.stamp = ros::Time::now();
    mesh.header.frame_id = kOrgan;
    mesh.organ = kOrgan;
    mesh.vertices = liver_.vertices();
    for (const FaceIndices& face : surface_.faces) {
      mesh.triangles.insert(mesh.triangles.end(), face.begin(), face.end());
    }
    mesh_publisher_.publish(mesh);
  }

  /// A tip's frame has its z axis along the shaft.
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

  void publish_marker(const ros::Time& stamp) {
    if (marker_publisher_.getNumSubscribers() == 0) return;
    visualization_msgs::Marker marker;
    marker.header.stamp = stamp;
    marker.header.frame_id = kOrgan;
    marker.ns = kOrgan;
    marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
    marker.pose.orientation.w = 1.0;
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
    marker.color.r = 0.62F;
    marker.color.g = 0.20F;
    marker.color.b = 0.16F;
    marker.color.a = 1.0F;
    const std::vector<float> vertices = liver_.vertices();
    for (const FaceIndices& face : surface_.faces) {
      for (const std::uint32_t vertex : face) {
        geometry_msgs::Point point;
        point.x = vertices[3 * vertex];
        point.y = vertices[3 * vertex + 1];
        point.z = vertices[3 * vertex + 2];
        marker.points.push_back(point);
      }
    }
    marker_publisher_.publish(marker);
  }

  double rate_;
  Surface surface_;
  LiverSoftBody liver_;
  std::map<std::string, std::vector<Push>> pushes_;  ///< by tool, since the last step
  long steps_ = 0;
  ros::Publisher mesh_publisher_;
  ros::Publisher vertices_publisher_;
  ros::Publisher marker_publisher_;
  ros::Subscriber contacts_subscriber_;
  tf2_ros::StaticTransformBroadcaster trocar_broadcaster_;
  tf2_ros::TransformBroadcaster tip_broadcaster_;
};

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  ros::init(argc, argv, "liver_simulator");
  ros::NodeHandle private_node("~");
  const double rate = private_node.param("rate", 125.0);
  const double fastest = 1.0 / organ_collision::kStabDuration;
  if (!(rate >= 20.0 && rate <= fastest)) {
    ROS_FATAL("rate is %g; it must be from 20 to %g Hz, so that a stab fits into one step", rate,
              fastest);
    return 2;
  }
  const std::string collision_node =
      private_node.param<std::string>("collision_node", "/organ_collision");
  organ_collision::LiverSimulator simulator(ros::NodeHandle(collision_node), private_node, rate);
  for (ros::Rate loop(rate); ros::ok(); loop.sleep()) {
    ros::spinOnce();
    simulator.step();
  }
}
