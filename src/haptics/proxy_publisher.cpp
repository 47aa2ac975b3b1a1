#include "proxy_publisher.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <ros/names.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>

#include "common/messages/conversions.hpp"
#include "common/messages/text.hpp"
#include "organ_collision/ros/names.hpp"
#include "places.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// The constants of the message have the values of the enumeration.
static_assert(ProxyState::NO_ANSWER == static_cast<int>(ProxyStatus::kNoAnswer) &&
              ProxyState::FREE == static_cast<int>(ProxyStatus::kFree) &&
              ProxyState::TOUCHING == static_cast<int>(ProxyStatus::kTouching) &&
              ProxyState::SQUEEZED == static_cast<int>(ProxyStatus::kSqueezed) &&
              ProxyState::PUNCTURED == static_cast<int>(ProxyStatus::kPunctured));

/// [messages] Late forces would be wrong, so only a few messages may wait.
constexpr std::uint32_t kQueue = 20;

std_msgs::Header header_of(const ProxyReport& report) {
  std_msgs::Header header;
  header.frame_id = report.frame;
  header.stamp = report.stamp;
  return header;
}

/// The message of a force, and a torque about the tool's centre.
geometry_msgs::Wrench wrench_about_origin(const ProxyReport& report, const Vector3d& force,
                                          const Vector3d& torque) {
  geometry_msgs::Wrench wrench;
  wrench.force = to_vector(force);
  wrench.torque = to_vector(torque + report.center.cross(force));
  return wrench;
}

}  // namespace

ProxyState state_of(const ProxyReport& report) {
  ProxyState state;
  state.header = header_of(report);
  state.tool = report.tool.name;
  state.message = plain_text(report.message, kLongestMessage);
  state.tick_sec = report.tick_sec;
  state.clipped = report.clipped_by != nullptr;
  state.fading = report.is_fading;
  state.hand.orientation.w = state.proxy.orientation.w = 1.0;
  if (report.hand) state.hand = pose_of(report.tool, *report.hand);
  if (report.proxy) state.proxy = pose_of(report.tool, *report.proxy);
  if (report.answer) {
    state.state = static_cast<std::uint8_t>(report.answer->state);
    state.placed_anew = report.answer->is_placed_anew;
    state.pull = to_vector(report.answer->pull);
    for (const TissueMotion& motion : report.scene->motions) {
      state.lag_sec = std::max({state.lag_sec, motion.lag_sec, motion.frame_lag_sec});
    }
    state.contacts = places_of(report, report.answer->contacts);
    state.hand_contacts = places_of(report, report.answer->hand_contacts);
  }
  state.center = tf2::toMsg(report.center);
  state.wrench = wrench_about_origin(report, force_of(report.forces), torque_of(report.forces));
  return state;
}

geometry_msgs::WrenchStamped wrench_at_tip(const ProxyReport& report) {
  const Eigen::Isometry3d& T_frame_tip = *report.tip_frame;
  const Eigen::Matrix3d R_tip_frame = T_frame_tip.linear().transpose();
  const Vector3d force = force_of(report.forces), arm = report.center - T_frame_tip.translation();
  geometry_msgs::WrenchStamped message;
  message.header.stamp = report.stamp;
  message.header.frame_id = tip_frame_of(report.tool);
  message.wrench.force = to_vector(R_tip_frame * force);
  message.wrench.torque = to_vector(R_tip_frame * (torque_of(report.forces) + arm.cross(force)));
  return message;
}

geometry_msgs::WrenchStamped wrench_of(const ProxyReport& report, const OrganForce& of_organ) {
  geometry_msgs::WrenchStamped message;
  message.header = header_of(report);
  message.wrench = wrench_about_origin(report, of_organ.force, of_organ.torque);
  return message;
}

VertexForces vertex_forces_of(const ProxyReport& report, const OrganForce& of_organ) {
  std::map<std::uint32_t, Vector3d> at_vertices;
  for (const FaceForce& at : of_organ.on_faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d force = -at.barycentric[k] * at.force;
      if (force.isZero(0.0)) continue;
      at_vertices.insert({at.vertices[k], Vector3d::Zero()}).first->second += force;
    }
  }
  VertexForces message;
  message.header.stamp = report.stamp;
  message.header.frame_id = of_organ.frame;
  message.mesh_stamp = of_organ.mesh_stamp;
  message.organ = of_organ.organ;
  message.topology = of_organ.topology;
  message.tool = report.tool.name;
  for (const auto& [vertex, force] : at_vertices) {
    message.vertices.push_back(vertex);
    message.forces.push_back(to_vector(force));
  }
  return message;
}

ProxyPublisher::ProxyPublisher(const ros::NodeHandle& private_node, FailureLog& failed,
                               bool publishes_tf)
    : private_node_(private_node), failed_(failed) {
  if (publishes_tf) frames_.emplace();
}

void ProxyPublisher::set_tools(const std::vector<ToolParameters>& tools) {
  std::map<std::string, ToolTopics> topics;
  for (const ToolParameters& tool : tools) {
    if (const auto known = tools_.find(tool.name); known != tools_.end()) {
      topics.insert(*known);
      continue;
    }
    const std::string name = tool_graph_name(tool.name);
    topics[tool.name] = {
        private_node_.advertise<geometry_msgs::PoseStamped>(ros::names::append(name, names::kProxy),
                                                            kQueue),
        private_node_.advertise<ProxyState>(ros::names::append(name, names::kState), kQueue),
        private_node_.advertise<geometry_msgs::WrenchStamped>(
            ros::names::append(name, names::kWrench), kQueue)};
  }
  tools_ = std::move(topics);
  for (auto pair = pairs_.begin(); pair != pairs_.end();) {
    pair = tools_.count(pair->first.first) == 0 ? pairs_.erase(pair) : std::next(pair);
  }
}

bool ProxyPublisher::has_readers(const ToolParameters& tool) const {
  return tools_.at(tool.name).state.getNumSubscribers() > 0;
}

void ProxyPublisher::publish(const ProxyReport& report) {
  ToolTopics& topics = tools_.at(report.tool.name);
  for (const OrganForce& of_organ : report.forces) {
    PairTopics* pair = pair_of(of_organ.organ, report.tool.name);
    if (pair) pair->wrench.publish(wrench_of(report, of_organ));
  }
  if (report.tip_frame) topics.wrench.publish(wrench_at_tip(report));
  publish_proxy(report, topics);
  topics.state.publish(state_of(report));
  for (const OrganForce& of_organ : report.forces) {
    PairTopics* pair = pair_of(of_organ.organ, report.tool.name);
    if (!pair || pair->vertex_forces.getNumSubscribers() == 0) continue;
    // Each shape has one answer, also where the tool answers the shapes of several organs.
    if (!report.answered_organ.empty() && of_organ.organ != report.answered_organ) continue;
    pair->vertex_forces.publish(vertex_forces_of(report, of_organ));
  }
}

void ProxyPublisher::publish_proxy(const ProxyReport& report, ToolTopics& topics) {
  if (!report.answer) return;
  const geometry_msgs::Pose pose = pose_of(report.tool, report.answer->proxy);
  if (topics.proxy.getNumSubscribers() > 0) {
    geometry_msgs::PoseStamped message;
    message.header = header_of(report);
    message.pose = pose;
    topics.proxy.publish(message);
  }
  if (!frames_ || topics.framed == report.stamp) return;
  topics.framed = report.stamp;
  geometry_msgs::TransformStamped transform;
  transform.header = header_of(report);
  transform.child_frame_id = tf_frame(report.tool.name + names::kProxyFrame);
  transform.transform.translation.x = pose.position.x;
  transform.transform.translation.y = pose.position.y;
  transform.transform.translation.z = pose.position.z;
  transform.transform.rotation = pose.orientation;
  frames_->sendTransform(transform);
}

/// The topics of an organ and a tool. Null if no name is free for them.
ProxyPublisher::PairTopics* ProxyPublisher::pair_of(const std::string& organ,
                                                    const std::string& tool) {
  const auto known = pairs_.find({tool, organ});
  if (known != pairs_.end()) return &known->second;
  try {
    const std::string name = names_.of(organ, tool);
    const PairTopics topics{private_node_.advertise<geometry_msgs::WrenchStamped>(
                                ros::names::append(name, names::kWrench), kQueue),
                            private_node_.advertise<VertexForces>(
                                ros::names::append(name, names::kVertexForces), kQueue)};
    return &pairs_.insert({{tool, organ}, topics}).first->second;
  } catch (const Rejection& rejection) {
    failed_.add(rejection.reason(), rejection.what(), std::chrono::steady_clock::now());
    return nullptr;
  }
}

}  // namespace organ_collision
