#include "proxy_publisher.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ContactArray.h>
#include <ros/master.h>
#include <ros/names.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <thread>

#include "common/messages/conversions.hpp"
#include "common/messages/text.hpp"
#include "common/threads/queues.hpp"
#include "geometry/concatenate.hpp"
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

/// [messages] Where roscpp drops messages, the force that a subscriber sees jumps. After a pause of
/// the process, a second of poses is answered at once, before roscpp sends one of the answers.
constexpr std::uint32_t kQueue = 1000;
/// How long to wait before a ROS master that did not answer is asked again, and before another look
/// for organs that are gone.
constexpr std::chrono::seconds kRetry(1);
/// Between the ends of two topics.
constexpr std::chrono::milliseconds kPause(2);

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

std::string fault_of(const ProxyReport& report, double force, double torque) {
  constexpr double kRounding = 1e-9;   // [1]
  constexpr double kSamePlace = 1e-3;  // [m] A tip that the tip frame places here is the hand's.
  const auto exceeds = [](double load, double limit, double before) {
    return !(load <= std::max(limit, before) * (1.0 + kRounding));  // Also true if it is NaN.
  };
  const double sum = force_of(report.forces).norm(), about = torque_of(report.forces).norm();
  if (exceeds(sum, report.limits.force, force)) {
    return concatenate("the force is ", sum, " N; at most ", report.limits.force, " N are legal");
  }
  if (exceeds(about, report.limits.torque, torque)) {
    return concatenate("the torque is ", about, " N m; at most ", report.limits.torque,
                       " N m are legal");
  }
  bool is_finite = report.center.allFinite();
  for (const OrganForce& of_organ : report.forces) {
    is_finite = is_finite && of_organ.force.allFinite() && of_organ.torque.allFinite();
    for (const FaceForce& at : of_organ.on_faces) is_finite = is_finite && at.force.allFinite();
  }
  if (report.answer) {
    const ShaftAxis& axis = report.answer->proxy.axis;
    is_finite = is_finite && axis.tip.allFinite() && axis.trocar.allFinite();
    for (const Eigen::Isometry3d& link : report.answer->proxy.links) {
      is_finite = is_finite && link.matrix().allFinite();
    }
    for (const auto* faces : {&report.answer->contacts, &report.answer->hand_contacts}) {
      for (const ProxyFace& at : *faces) {
        is_finite = is_finite && at.contact.point.allFinite() && at.contact.normal.allFinite() &&
                    std::isfinite(at.contact.depth) && std::isfinite(at.clearance);
      }
    }
  }
  if (!is_finite) return "a place or a force is not a finite number";
  if (!report.tip_frame || !report.hand || !report.tool.has_shaft()) return {};
  const double apart = (*report.tip_frame * report.tool.tip_offset - report.hand->axis.tip).norm();
  if (apart <= kSamePlace) return {};
  return concatenate("the tip frame places the tip ", apart, " m from the tip of the hand");
}

ProxyPublisher::ProxyPublisher(const ros::NodeHandle& private_node, const OrganRegistry& organs,
                               FailureLog& failed, bool publishes_tf, Threads threads)
    : private_node_(private_node), organs_(organs), failed_(failed), threads_(threads) {
  if (publishes_tf) frames_.emplace();
}

ProxyPublisher::Tools ProxyPublisher::prepare(const std::vector<Tool>& tools) const {
  Tools added;
  ros::NodeHandle node = private_node_;
  for (const Tool& tool : tools) {
    if (tools_.count(tool.parameters.name) > 0) continue;
    const std::string name = tool_graph_name(tool.parameters.name);
    added[tool.parameters.name] = {
        node.advertise<geometry_msgs::PoseStamped>(ros::names::append(name, names::kProxy), kQueue),
        node.advertise<ProxyState>(ros::names::append(name, names::kState), kQueue),
        node.advertise<geometry_msgs::WrenchStamped>(ros::names::append(name, names::kWrench),
                                                     kQueue)};
  }
  return added;
}

void ProxyPublisher::set_tools(const std::vector<Tool>& tools, Tools added) {
  std::set<std::string> named;
  for (const Tool& tool : tools) named.insert(tool.parameters.name);
  tools_.merge(added);
  for (auto tool = tools_.begin(); tool != tools_.end();) {
    if (named.count(tool->first) == 0) {
      end({tool->second.proxy, tool->second.state, tool->second.wrench});
    }
    tool = named.count(tool->first) == 0 ? tools_.erase(tool) : std::next(tool);
  }
  for (auto pair = pairs_.begin(); pair != pairs_.end();) {
    const bool stays = named.count(pair->second.tool) > 0;
    if (!stays) end({pair->second.wrench, pair->second.vertex_forces});
    pair = stays ? std::next(pair) : pairs_.erase(pair);
  }
}

bool ProxyPublisher::has_readers(const ToolParameters& tool) const {
  return tools_.at(tool.name).state.getNumSubscribers() > 0;
}

void ProxyPublisher::publish(const ProxyReport& report) {
  ToolTopics& topics = tools_.at(report.tool.name);
  const Time now = std::chrono::steady_clock::now();
  const std::string fault = fault_of(report, topics.force, topics.torque);
  if (!fault.empty()) {
    failed_.add("withheld", "tool '" + report.tool.name + "': " + fault, now);
    ProxyReport without{report.tool, report.frame, report.stamp, ContactArray::INVALID_REQUEST,
                        "no answer: " + fault};
    for (const OrganForce& of_organ : report.forces) {
      without.forces.push_back({of_organ.organ, of_organ.frame, of_organ.topology});
    }
    // Where the tip is does not matter to a wrench of zero.
    if (report.tip_frame) without.tip_frame = Eigen::Isometry3d::Identity();
    return publish(without);
  }
  const std::vector<PairTopics*> pairs = publish_wrenches(report, topics, now);
  publish_proxy(report, topics);
  const ProxyState state = state_of(report);
  topics.state.publish(state);
  if (report.tool.lockstep) topics.last = state;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i] || pairs[i]->vertex_forces.getNumSubscribers() == 0) continue;
    // Each shape has one answer, also where the tool answers the shapes of several organs.
    const OrganForce& of_organ = report.forces[i];
    if (!report.answered_organ.empty() && of_organ.organ != report.answered_organ) continue;
    pairs[i]->vertex_forces.publish(vertex_forces_of(report, of_organ));
  }
}

/// Returns the topics of the pairs, in the order of the report's forces.
std::vector<ProxyPublisher::PairTopics*> ProxyPublisher::publish_wrenches(const ProxyReport& report,
                                                                          ToolTopics& topics,
                                                                          Time now) {
  topics.force = force_of(report.forces).norm();
  topics.torque = torque_of(report.forces).norm();
  std::vector<PairTopics*> pairs;
  for (const OrganForce& of_organ : report.forces) {
    pairs.push_back(pair_of(of_organ.organ, report.tool.name, now));
    if (pairs.back()) pairs.back()->wrench.publish(wrench_of(report, of_organ));
  }
  if (report.tip_frame) topics.wrench.publish(wrench_at_tip(report));
  return pairs;
}

void ProxyPublisher::publish_again(ProxyReport lowered) {
  ToolTopics& topics = tools_.at(lowered.tool.name);
  lowered.stamp = topics.last.header.stamp;
  publish_wrenches(lowered, topics, std::chrono::steady_clock::now());
  topics.last.wrench =
      wrench_about_origin(lowered, force_of(lowered.forces), torque_of(lowered.forces));
  topics.last.clipped = true;
  topics.state.publish(topics.last);
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

/// The topics of an organ and a tool. Null if they are not there yet, or if no name is free for
/// them.
ProxyPublisher::PairTopics* ProxyPublisher::pair_of(const std::string& organ,
                                                    const std::string& tool, Time now) {
  constexpr std::chrono::milliseconds kFading(100);  // The last force of an organ that is gone.
  const std::string name = pair_graph_name(organ, tool);
  PairTopics& pair = pairs_.insert({name, {organ, tool}}).first->second;
  if (pair.organ != organ) {
    if (organs_.organs().count(pair.organ) > 0) {
      failed_.add("name taken",
                  "the topics " + name + " belong to organ '" + pair.organ + "', tool '" + tool +
                      "'; the names must differ in letters or digits",
                  now);
      return nullptr;
    }
    if (now - pair.used < kFading) return nullptr;
    pair.organ = organ;
  }
  pair.used = now;
  if (!pair.is_there && now >= pair.ask) ask_for(name, pair);
  return pair.is_there ? &pair : nullptr;
}

/// Tells the ROS master of topics, in another thread.
void ProxyPublisher::ask_for(const std::string& name, PairTopics& pair) {
  pair.ask = Time::max();
  call_later(threads_.master, [this, name, node = private_node_]() mutable {
    ros::Publisher wrench, forces;
    if (ros::master::check()) {  // Without a master, roscpp would wait until there is one.
      wrench = node.advertise<geometry_msgs::WrenchStamped>(
          ros::names::append(name, names::kWrench), kQueue);
      forces = node.advertise<VertexForces>(ros::names::append(name, names::kVertexForces), kQueue);
    }
    call_later(threads_.node, [this, name, wrench, forces] { take(name, wrench, forces); });
  });
}

/// Takes topics over. They are empty if no master answers.
void ProxyPublisher::take(const std::string& name, const ros::Publisher& wrench,
                          const ros::Publisher& forces) {
  const auto pair = pairs_.find(name);
  const bool is_wanted = pair != pairs_.end() && !pair->second.is_there;
  if (!wrench) {
    if (is_wanted) pair->second.ask = std::chrono::steady_clock::now() + kRetry;
  } else if (is_wanted) {
    pair->second.is_there = true;
    pair->second.wrench = wrench;
    pair->second.vertex_forces = forces;
  } else {
    end({wrench, forces});
  }
}

void ProxyPublisher::end_unused(Time now) {
  if (now < next_look_) return;
  next_look_ = now + kRetry;
  for (auto pair = pairs_.begin(); pair != pairs_.end();) {
    const PairTopics& topics = pair->second;
    const bool stays = organs_.organs().count(topics.organ) > 0 || now - topics.used < kGrace;
    if (!stays) end({topics.wrench, topics.vertex_forces});
    pair = stays ? std::next(pair) : pairs_.erase(pair);
  }
}

/// Tells the ROS master in another thread that topics end. Until the master has answered, roscpp
/// holds the mutex that each publish() needs. So the master is asked before whether it answers. The
/// pauses let publish() have the mutex.
void ProxyPublisher::end(const std::vector<ros::Publisher>& topics) {
  for (const ros::Publisher& topic : topics) {
    if (!topic) continue;
    call_later(threads_.master, [topic = topic]() mutable {
      ros::master::check();
      topic = {};
      std::this_thread::sleep_for(kPause);
    });
  }
}

}  // namespace organ_collision
