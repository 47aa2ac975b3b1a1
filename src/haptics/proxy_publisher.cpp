#include "proxy_publisher.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ContactArray.h>
#include <ros/names.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>

#include "common/messages/conversions.hpp"
#include "common/messages/text.hpp"
#include "haptics/basins.hpp"
#include "node/steps/contact_array.hpp"
#include "organ_collision/ros/names.hpp"

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
/// The most places of a state.
constexpr std::size_t kMostPlaces = 32;
/// [m] Faces around a corner whose nearest points are nearer to each other than this are one place.
constexpr double kSamePlace = 1e-6;

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

/// The contacts that basins_of() compares: those of one organ.
std::vector<Contact> contacts_with(const ProxyAnswer& answer, std::size_t organ) {
  std::vector<Contact> contacts;
  for (const ProxyFace& at : answer.contacts) {
    if (at.organ == organ) contacts.push_back(to_message(at.contact));
  }
  return contacts;
}

/// [N] The published force of the proxy on faces of an organ, by face and link, in the proxy's
/// frame. `index`: of the organ in the scene.
std::map<std::pair<std::uint32_t, std::int32_t>, Vector3d> forces_on(const ProxyReport& report,
                                                                     std::size_t index) {
  const ProxyOrgan& organ = report.scene->organs[index];
  const std::string& name = report.scene->sources[index]->name();
  std::map<std::pair<std::uint32_t, std::int32_t>, Vector3d> forces;
  for (const OrganForce& of_organ : report.forces) {
    if (of_organ.organ != name || of_organ.topology != organ.shape->topology()) continue;
    for (const FaceForce& at : of_organ.on_faces) {
      const Vector3d force = -(organ.T_organ_proxy.linear().transpose() * at.force);
      forces.insert({{at.face, at.link}, Vector3d::Zero()}).first->second += force;
    }
  }
  return forces;
}

/// What ProxyState.contacts has. `report`: with an answer.
std::vector<ProxyContact> places_of(const ProxyReport& report) {
  std::vector<ProxyContact> places;
  for (std::size_t organ = 0; organ < report.scene->organs.size(); ++organ) {
    const std::vector<Contact> contacts = contacts_with(*report.answer, organ);
    if (contacts.empty()) continue;
    const std::vector<std::size_t> basins = basins_of(contacts);
    const auto forces = forces_on(report, organ);
    std::vector<Vector3d> of_patch(contacts.size(), Vector3d::Zero());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const auto force = forces.find({contacts[i].face, contacts[i].link});
      if (force != forces.end()) of_patch[basins[i]] += force->second;
    }
    std::size_t i = 0;
    for (const ProxyFace& at : report.answer->contacts) {
      if (at.organ != organ) continue;
      const std::size_t index = i++;
      if (basins[index] != index) continue;
      ProxyContact& place = places.emplace_back();
      place.organ = report.scene->sources[organ]->name();
      place.link = contacts[index].link;
      place.face = contacts[index].face;
      place.vertices = contacts[index].vertices;
      place.barycentric = contacts[index].barycentric;
      place.point = contacts[index].point;
      place.normal = contacts[index].normal;
      place.distance = -contacts[index].depth;
      place.velocity = to_vector(tissue_velocity(*report.scene, organ, at.contact));
      place.force = to_vector(of_patch[index]);
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  std::vector<ProxyContact> different;
  for (const ProxyContact& place : places) {
    const auto same = std::find_if(different.begin(), different.end(), [&](const auto& other) {
      return other.organ == place.organ && other.link == place.link &&
             (to_eigen(other.point) - to_eigen(place.point)).norm() < kSamePlace;
    });
    if (same != different.end()) {
      same->force = to_vector(to_eigen(same->force) + to_eigen(place.force));
    } else {
      different.push_back(place);
    }
  }
  // Where there are more places than a state has, those that bear a force stay.
  for (auto at = different.end(); different.size() > kMostPlaces && at != different.begin();) {
    --at;
    if (to_eigen(at->force).isZero(0.0)) at = different.erase(at);
  }
  return different;
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
    state.contacts = places_of(report);
  }
  state.center = tf2::toMsg(report.center);
  state.wrench = wrench_about_origin(report, force_of(report.forces), torque_of(report.forces));
  return state;
}

geometry_msgs::WrenchStamped wrench_of(const ProxyReport& report, const OrganForce& of_organ) {
  geometry_msgs::WrenchStamped message;
  message.header = header_of(report);
  message.wrench = wrench_about_origin(report, of_organ.force, of_organ.torque);
  return message;
}

VertexForces vertex_forces_of(const ProxyReport& report, const OrganForce& of_organ) {
  ContactArray about;
  about.header.stamp = report.stamp;
  about.header.frame_id = of_organ.frame;
  about.organ = of_organ.organ;
  about.topology = of_organ.topology;
  about.tool = report.tool.name;
  return vertex_forces(about, of_organ.on_faces);
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
        private_node_.advertise<ProxyState>(ros::names::append(name, names::kState), kQueue)};
  }
  tools_ = std::move(topics);
  for (auto pair = pairs_.begin(); pair != pairs_.end();) {
    pair = tools_.count(pair->first.first) == 0 ? pairs_.erase(pair) : std::next(pair);
  }
}

void ProxyPublisher::publish(const ProxyReport& report) {
  ToolTopics& topics = tools_.at(report.tool.name);
  for (const OrganForce& of_organ : report.forces) {
    PairTopics* pair = pair_of(of_organ.organ, report.tool.name);
    if (pair) pair->wrench.publish(wrench_of(report, of_organ));
  }
  publish_proxy(report, topics);
  topics.state.publish(state_of(report));
  for (const OrganForce& of_organ : report.forces) {
    PairTopics* pair = pair_of(of_organ.organ, report.tool.name);
    if (!pair || pair->vertex_forces.getNumSubscribers() == 0) continue;
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
