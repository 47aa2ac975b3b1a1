#include "ros_link.hpp"

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/VertexForces.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <map>
#include <stdexcept>

using organ_collision::OrganMesh;
using organ_collision::OrganVertices;
using organ_collision::VertexForces;

namespace {

constexpr char kWorld[] = "world";

ros::NodeHandle start() {
  if (!ros::isInitialized()) {
    int argc = 0;
    ros::init(argc, nullptr, "sofa", ros::init_options::NoSigintHandler);
  }
  if (!ros::master::check())
    throw std::runtime_error("there is no ROS master at " + ros::master::getURI() +
                             "; start the nodes first");
  return {};
}

/// What is known of an organ.
struct Organ {
  ros::Publisher mesh;
  std::vector<std::uint32_t> triangles;  ///< as they were sent last
  std::uint32_t topology = 0;
  std::map<std::string, VertexForces> forces;  ///< the last ones, by tool
  std::vector<ros::Subscriber> subscribers;
};

}  // namespace

struct RosLink::State {
  ros::NodeHandle node = start();
  std::vector<std::string> tools;
  ros::WallDuration patience;
  ros::CallbackQueue queue;  ///< its callbacks are called in wait_for_forces()
  ros::Publisher transforms, vertices;
  std::map<std::string, Organ> organs;  ///< by name
  std::vector<std::string> names;       ///< of the organs that were sent last
  ros::Time stamp;                      ///< of the shapes that were sent last

  Organ& organ(const std::string& name);
  void publish(const OrganSurface& surface);
  bool is_awaiting() const;
};

RosLink::RosLink(const std::vector<std::string>& tools, double lockstep_sec)
    : state_(std::make_unique<State>()) {
  state_->tools = tools;
  state_->patience = ros::WallDuration(lockstep_sec);
  state_->node.setCallbackQueue(&state_->queue);
  state_->transforms = state_->node.advertise<tf2_msgs::TFMessage>("/tf", 100);
  state_->vertices = state_->node.advertise<OrganVertices>("organ_collision/organ_vertices", 10);
}
RosLink::~RosLink() = default;

Organ& RosLink::State::organ(const std::string& name) {
  const auto known = organs.find(name);
  if (known != organs.end()) return known->second;
  Organ& organ = organs[name];
  // A publisher for each organ, because a latched one sends only its last mesh to a node that comes
  // later.
  organ.mesh = node.advertise<OrganMesh>("organ_collision/organ_mesh", 1, true);
  for (const std::string& tool : tools) {
    const boost::function<void(const VertexForces&)> keep =
        [&forces = organ.forces[tool]](const VertexForces& message) { forces = message; };
    organ.subscribers.push_back(node.subscribe<VertexForces>(
        "haptic_proxy/" + name + "/" + tool + "/vertex_forces", 10, keep));
  }
  return organ;
}

void RosLink::send(const std::vector<ToolFrame>& frames, const std::vector<OrganSurface>& organs) {
  state_->stamp = ros::Time::now();
  tf2_msgs::TFMessage message;
  for (const ToolFrame& frame : frames) {
    geometry_msgs::TransformStamped& transform = message.transforms.emplace_back();
    transform.header.stamp = state_->stamp;
    transform.header.frame_id = kWorld;
    transform.child_frame_id = frame.name;
    auto& place = transform.transform.translation;
    auto& rotation = transform.transform.rotation;
    place.x = frame.position[0];
    place.y = frame.position[1];
    place.z = frame.position[2];
    rotation.x = frame.orientation[0];
    rotation.y = frame.orientation[1];
    rotation.z = frame.orientation[2];
    rotation.w = frame.orientation[3];
  }
  state_->transforms.publish(message);
  state_->names.clear();
  for (const OrganSurface& organ : organs) {
    state_->names.push_back(organ.name);
    state_->publish(organ);
  }
}

void RosLink::State::publish(const OrganSurface& surface) {
  Organ& known = organ(surface.name);
  OrganVertices shape;
  shape.header.stamp = stamp;
  shape.header.frame_id = kWorld;
  shape.organ = surface.name;
  shape.vertices = surface.vertices;
  if (surface.triangles == known.triangles) {
    shape.topology = known.topology;
    return vertices.publish(shape);
  }
  if (!known.triangles.empty()) ++known.topology;
  known.triangles = surface.triangles;
  OrganMesh mesh;
  mesh.header = shape.header;
  mesh.organ = shape.organ;
  mesh.topology = known.topology;
  mesh.vertices = shape.vertices;
  mesh.triangles = surface.triangles;
  known.mesh.publish(mesh);
}

/// Whether forces on the last shapes are to come. A haptic_proxy that has never answered, or that
/// has no answer, is not waited for.
bool RosLink::State::is_awaiting() const {
  return std::any_of(organs.begin(), organs.end(), [this](const auto& organ) {
    const auto& forces = organ.second.forces;
    return std::any_of(forces.begin(), forces.end(), [this](const auto& of) {
      return !of.second.mesh_stamp.isZero() && of.second.mesh_stamp < stamp;
    });
  });
}

std::vector<VertexForce> RosLink::wait_for_forces() {
  const ros::WallTime last = ros::WallTime::now() + state_->patience;
  state_->queue.callAvailable();
  while (ros::ok() && state_->is_awaiting() && ros::WallTime::now() < last)
    state_->queue.callOne(last - ros::WallTime::now());
  std::vector<VertexForce> result;
  for (std::size_t organ = 0; organ < state_->names.size(); ++organ) {
    for (auto& [tool, forces] : state_->organ(state_->names[organ]).forces) {
      if (forces.mesh_stamp != state_->stamp) forces = {};
      for (std::size_t i = 0; i < forces.vertices.size(); ++i) {
        const geometry_msgs::Vector3& force = forces.forces[i];
        result.push_back({organ, forces.vertices[i], {force.x, force.y, force.z}});
      }
    }
  }
  return result;
}
