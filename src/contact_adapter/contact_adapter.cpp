#include "contact_adapter.hpp"

#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/VertexForces.h>
#include <ros/names.h>
#include <ros/param.h>
#include <std_msgs/UInt32MultiArray.h>

#include "contact_adapter_parameters.hpp"
#include "contact_answer.hpp"
#include "forces/forces.hpp"
#include "organ_collision/ros/names.hpp"
#include "ros/messages/checked_messages.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

// [messages] Late forces would be wrong, so only a few messages may wait, for all organs and tools.
constexpr std::uint32_t kQueue = 20;

}  // namespace

ContactAdapter::ContactAdapter(ros::NodeHandle node, const ros::NodeHandle& private_node)
    : private_node_(private_node),
      parameters_(load_contact_adapter_parameters(private_node)),
      live_parameters_(private_node, live_parameters(parameters_),
                       [this](const XmlRpc::XmlRpcValue& changes) {
                         LiveContactAdapterParameters& live = parameters_;
                         live = changed(parameters_, changes);
                       }),
      updater_(node, private_node, private_node.getNamespace()),
      master_(private_node.getNamespace()) {
  for (const std::string& sentence : parameters_.misspelt) ROS_WARN("%s", sentence.c_str());
  live_parameters_.advertise();
  updater_.setHardwareID("none");
  updater_.add("contacts", this, &ContactAdapter::diagnose);
  master_.add_to(updater_);
  // A timer of wall time, because the updater's own period stops when simulated time stops.
  diagnostic_timer_ = private_node_.createWallTimer(
      ros::WallDuration(parameters_.diagnostic_period_sec),
      [this](const ros::WallTimerEvent&) { updater_.force_update(); });
  subscriber_ = subscribe_checked<ContactArray>(
      node, ros::names::append(names::kNode, names::kContacts), kQueue,
      [this](const auto& event) { on_contacts(*event.getConstMessage()); }, failures_);
  ROS_INFO("ready: contacts of %s, %g N/m", subscriber_.getTopic().c_str(), parameters_.stiffness);
}

void ContactAdapter::on_contacts(const ContactArray& message) {
  ++received_;
  try {
    if (message.status != ContactArray::OK) {
      const std::string reason = reason_of(message.status);
      throw Rejection(message.status, reason, message.message.empty() ? reason : message.message);
    }
    check_contacts(message);
    publish(message, pair_of(message.organ, message.tool));
  } catch (const Rejection& rejection) {
    failures_.add(rejection.reason(),
                  "organ '" + plain_text(message.organ, kLongestName) + "', tool '" +
                      plain_text(message.tool, kLongestName) + "': " + rejection.what(),
                  std::chrono::steady_clock::now());
  }
}

void ContactAdapter::publish(const ContactArray& contacts, Pair& pair) {
  std::vector<FaceForce> forces;
  if (has_geometry(contacts)) {
    forces = forces_of(contacts, pair);
    geometry_msgs::WrenchStamped wrench;
    wrench.header = contacts.header;
    wrench.wrench = wrench_of(forces);
    pair.wrench.publish(wrench);
  }
  pair.faces.publish(face_list(contacts));
  if (has_geometry(contacts)) pair.vertex_forces.publish(vertex_forces(contacts, forces));
}

std::vector<FaceForce> ContactAdapter::forces_of(const ContactArray& contacts, Pair& pair) {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - pair.evaluated).count();
  pair.evaluated = now;
  std::vector<FaceForce> forces =
      pair.law.follow(contacts, seconds, parameters_.stiffness, radius_of(contacts.tool));
  if (limit_force(forces, parameters_.max_force)) {
    clipped_.add("max_force",
                 "organ '" + contacts.organ + "', tool '" + contacts.tool +
                     "': the force is clipped to " + std::to_string(parameters_.max_force) + " N",
                 std::chrono::steady_clock::now());
  }
  return forces;
}

/// Reads the parameters of the node that publishes the contacts. The cached look-up notices changes
/// of the parameter, and does not call the parameter server each time.
KeptSides::Radius ContactAdapter::radius_of(const std::string& tool) const {
  XmlRpc::XmlRpcValue tools;
  const std::string node = ros::names::parentNamespace(subscriber_.getTopic());
  ros::param::getCached(ros::names::append(node, names::kTools), tools);
  return shaft_radius(tools, tool);
}

ContactAdapter::Pair& ContactAdapter::pair_of(const std::string& organ, const std::string& tool) {
  const auto known = pairs_.find({organ, tool});
  if (known != pairs_.end()) return known->second;
  if (!radius_of(tool)) {
    ROS_INFO("the radius of tool '%s' is not known: past a face its contacts tell the depth",
             tool.c_str());
  }
  const std::string name = names_.of(organ, tool);
  const Pair pair{
      private_node_.advertise<std_msgs::UInt32MultiArray>(ros::names::append(name, names::kFaces),
                                                          kQueue),
      private_node_.advertise<geometry_msgs::WrenchStamped>(
          ros::names::append(name, names::kWrench), kQueue),
      private_node_.advertise<VertexForces>(ros::names::append(name, names::kVertexForces), kQueue),
      ForceLaw(parameters_.way_out)};
  return pairs_.insert({{organ, tool}, pair}).first->second;
}

void ContactAdapter::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  status.summary(DiagnosticStatus::OK, std::to_string(pairs_.size()) + " pairs of organ and tool");
  if (received_ == 0) {
    status.summary(DiagnosticStatus::WARN, "nothing came yet on " + subscriber_.getTopic());
  }
  status.add("messages", received_);
  for (const std::string& sentence : parameters_.misspelt) {
    status.mergeSummary(DiagnosticStatus::WARN, sentence);
  }
  show_failures("unpublished", failures_, status);
  show_failures("clipped", clipped_, status);
}

}  // namespace organ_collision
