// A plugin of the simulator AMBF. At each step of the physics, it sends the surfaces of all soft
// bodies and the poses of all rigid bodies, with one stamp. It moves soft bodies by the forces of
// haptic_proxy on their vertices, and bodies that show a proxy to where the proxy is.
//
// Parameters, in the namespace organ_collision_plugin
//   unit           [m] the length of AMBF's unit in this scene; default: 1
//   tools          for each tool of haptic_proxy whose forces move the soft bodies, the rigid body
//                  that shows its proxy; default: none
//   lockstep_sec   [s] how long a step waits for the forces on the shape that it sent; default:
//   0.01

#include <BulletSoftBody/btSoftBody.h>
#include <afConversions.h>
#include <afFramework.h>
#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/VertexForces.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace {

using geometry_msgs::PoseStamped;
using organ_collision::OrganMesh;
using organ_collision::OrganVertices;
using organ_collision::VertexForces;

constexpr char kWorld[] = "world";

/// A soft body, which is an organ with the same name.
struct Tissue {
  btSoftBody* body;
  OrganVertices shape;
  ros::Publisher mesh;
  std::map<std::string, VertexForces> forces;  ///< the last ones, by tool
};

class OrganCollisionPlugin : public ambf::afSimulatorPlugin {
 public:
  int init(int argc, char** argv, const ambf::afWorldPtr world) override {
    m_worldPtr = world;
    if (!ros::isInitialized()) ros::init(argc, argv, "ambf", ros::init_options::NoSigintHandler);
    node_ = std::make_unique<ros::NodeHandle>();
    node_->setCallbackQueue(&queue_);
    const ros::NodeHandle parameters("organ_collision_plugin");
    parameters.param("unit", unit_, 1.0);
    parameters.param("lockstep_sec", lockstep_sec_, 0.01);
    parameters.getParam("tools", bodies_);
    if (!(unit_ > 0.0)) {
      ROS_ERROR("%s is %g; must be above 0", parameters.resolveName("unit").c_str(), unit_);
      return -1;
    }
    transforms_ = node_->advertise<tf2_msgs::TFMessage>("/tf", 100);
    vertices_ = node_->advertise<OrganVertices>("organ_collision/organ_vertices", 10);
    for (const auto& [tool, body] : bodies_) show_proxy(tool, body);
    return 1;
  }

  /// AMBF calls it after each step of the physics, of `duration` [s].
  void physicsUpdate(double duration) override {
    if (!ros::ok()) return;
    const ros::Time stamp(m_worldPtr->getCurrentTimeStamp());
    send_poses(stamp);
    for (const auto& [key, object] : *m_worldPtr->getSoftBodyMap()) {
      auto* body = static_cast<ambf::afSoftBodyPtr>(object);
      const auto known = tissues_.find(body->getName());
      send_shape(known != tissues_.end() ? known->second : add_tissue(*body), stamp);
    }
    wait_for_forces(stamp);
    for (auto& [organ, tissue] : tissues_) move(tissue, stamp, duration);
  }

 private:
  void show_proxy(const std::string& tool, const std::string& name) {
    const boost::function<void(const PoseStamped&)> place = [this, name](const PoseStamped& proxy) {
      for (const auto& [key, object] : *m_worldPtr->getRigidBodyMap()) {
        if (object->getName() != name) continue;
        const auto& p = proxy.pose.position;
        const auto& q = proxy.pose.orientation;
        const btTransform pose(btQuaternion(q.x, q.y, q.z, q.w), btVector3(p.x, p.y, p.z) / unit_);
        object->setLocalTransform(to_cTransform(pose));
      }
    };
    subscribers_.push_back(
        node_->subscribe<PoseStamped>("haptic_proxy/" + tool + "/proxy", 1, place));
  }

  void send_poses(ros::Time stamp) {
    tf2_msgs::TFMessage message;
    for (const auto& [key, object] : *m_worldPtr->getRigidBodyMap()) {
      const btTransform pose = to_btTransform(object->getLocalTransform());
      const btVector3 p = pose.getOrigin() * unit_;
      const btQuaternion q = pose.getRotation();
      const Eigen::Translation3d place(p.x(), p.y(), p.z());
      const Eigen::Quaterniond rotation(q.w(), q.x(), q.y(), q.z());
      message.transforms.push_back(tf2::eigenToTransform(place * rotation));
      message.transforms.back().header.stamp = stamp;
      message.transforms.back().header.frame_id = kWorld;
      message.transforms.back().child_frame_id = object->getName();
    }
    transforms_.publish(message);
  }

  Tissue& add_tissue(ambf::afSoftBody& body) {
    const std::string organ = body.getName();
    Tissue& tissue = tissues_[organ];
    tissue.body = body.m_bulletSoftBody;
    tissue.shape.organ = organ;
    tissue.shape.header.frame_id = kWorld;
    tissue.shape.vertices.resize(3 * tissue.body->m_nodes.size());
    // A publisher for each organ, because a latched one sends only its last mesh to a node that
    // comes later.
    tissue.mesh = node_->advertise<OrganMesh>("organ_collision/organ_mesh", 1, true);
    for (const auto& [tool, shown] : bodies_) {
      const boost::function<void(const VertexForces&)> keep =
          [&tissue, tool = tool](const VertexForces& forces) { tissue.forces[tool] = forces; };
      subscribers_.push_back(node_->subscribe<VertexForces>(
          "haptic_proxy/" + organ + "/" + tool + "/vertex_forces", 10, keep));
    }
    return tissue;
  }

  void send_shape(Tissue& tissue, ros::Time stamp) {
    const auto& nodes = tissue.body->m_nodes;
    OrganVertices& shape = tissue.shape;
    for (int i = 0; i < nodes.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis)
        shape.vertices[3 * i + axis] = float(nodes[i].m_x[axis] * unit_);
    }
    const bool is_first = shape.header.stamp.isZero();
    shape.header.stamp = stamp;
    if (!is_first) return vertices_.publish(shape);
    OrganMesh mesh;
    mesh.header = shape.header;
    mesh.organ = shape.organ;
    mesh.vertices = shape.vertices;
    const auto& faces = tissue.body->m_faces;
    for (int i = 0; i < faces.size(); ++i) {
      for (const btSoftBody::Node* node : faces[i].m_n)
        mesh.triangles.push_back(std::uint32_t(node - &nodes[0]));
    }
    tissue.mesh.publish(mesh);
  }

  /// Does not wait for a haptic_proxy that has never answered, or that has no answer.
  void wait_for_forces(ros::Time stamp) {
    const auto is_awaited = [&](const VertexForces& forces) {
      return !forces.mesh_stamp.isZero() && forces.mesh_stamp < stamp;
    };
    const auto await = [&] {
      return std::any_of(tissues_.begin(), tissues_.end(), [&](const auto& tissue) {
        const auto& forces = tissue.second.forces;
        return std::any_of(forces.begin(), forces.end(),
                           [&](const auto& of) { return is_awaited(of.second); });
      });
    };
    const ros::WallTime last = ros::WallTime::now() + ros::WallDuration(lockstep_sec_);
    queue_.callAvailable();
    while (await() && ros::WallTime::now() < last) queue_.callOne(last - ros::WallTime::now());
  }

  /// Gives the nodes the impulses of the forces on this shape. Without them, haptic_proxy is gone.
  void move(Tissue& tissue, ros::Time stamp, double duration) {
    for (auto& [tool, forces] : tissue.forces) {
      if (forces.mesh_stamp != stamp) forces = {};
      for (std::size_t i = 0; i < forces.vertices.size(); ++i) {
        if (forces.vertices[i] >= tissue.shape.vertices.size() / 3) continue;
        const auto& force = forces.forces[i];
        btSoftBody::Node& node = tissue.body->m_nodes[int(forces.vertices[i])];
        node.m_v += btVector3(force.x, force.y, force.z) * (duration * node.m_im / unit_);
      }
    }
  }

  double unit_ = 1.0, lockstep_sec_ = 0.01;
  std::map<std::string, std::string> bodies_;  ///< the shown ones, by tool
  std::map<std::string, Tissue> tissues_;
  ros::CallbackQueue queue_;  ///< its callbacks are called in physicsUpdate()
  std::unique_ptr<ros::NodeHandle> node_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher transforms_, vertices_;
};

}  // namespace

AF_REGISTER_SIMULATOR_PLUGIN(OrganCollisionPlugin)
