#include "contact_adapter.hpp"

#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/UInt32MultiArray.h>

#include "contact_check.hpp"
#include "face_list.hpp"
#include "organ_collision/ros/answers.hpp"
#include "organ_collision/ros/diagnostics.hpp"
#include "organ_collision/ros/names.hpp"
#include "organ_collision/ros/plain_text.hpp"
#include "organ_collision/ros/rejection.hpp"
#include "penalty_wrench.hpp"

namespace organ_collision {
namespace {

// Messages. Forces that come late push wrongly: few may wait, of as many organs and tools.
constexpr std::uint32_t kQueue = 20;

}  // namespace

ContactAdapter::ContactAdapter(ros::NodeHandle node, const ros::NodeHandle& private_node)
    : private_node_(private_node),
      parameters_(load_contact_adapter_parameters(private_node)),
      updater_(node, private_node, private_node.getNamespace()) {
  for (const std::string& sentence : parameters_.misspelt) ROS_WARN("%s", sentence.c_str());
  updater_.setHardwareID("none");
  updater_.add("contacts", this, &ContactAdapter::diagnose);
  // Of wall time: the updater's own period stands still with simulated time.
  diagnostic_timer_ = private_node_.createWallTimer(
      ros::WallDuration(parameters_.diagnostic_period_sec),
      [this](const ros::WallTimerEvent&) { updater_.force_update(); });
  subscriber_ =
      node.subscribe(ros::names::append(names::kNode, names::kContacts), kQueue,
                     &ContactAdapter::on_contacts, this, ros::TransportHints().tcpNoDelay());
  ROS_INFO("ready: contacts of %s, %g N/m", subscriber_.getTopic().c_str(), parameters_.stiffness);
}

void ContactAdapter::on_contacts(const ContactArray& message) {
  ++received_;
  try {
    if (message.status != ContactArray::OK) {
      throw Rejection(message.status, reason_of(message.status), message.message);
    }
    check_contacts(message);
    publish(message, topics_of(message.organ, message.tool));
  } catch (const Rejection& rejection) {
    failures_.add(rejection.reason(),
                  "organ '" + plain_text(message.organ, kLongestName) + "', tool '" +
                      plain_text(message.tool, kLongestName) + "': " + rejection.what(),
                  std::chrono::steady_clock::now());
  }
}

void ContactAdapter::publish(const ContactArray& contacts, const Topics& topics) {
  if (has_geometry(contacts))
    topics.wrench.publish(penalty_wrench(contacts, parameters_.stiffness));
  topics.faces.publish(face_list(contacts));
}

const ContactAdapter::Topics& ContactAdapter::topics_of(const std::string& organ,
                                                        const std::string& tool) {
  const auto known = topics_.find({organ, tool});
  if (known != topics_.end()) return known->second;
  const std::string name = names_.of(organ, tool);
  const Topics topics{
      private_node_.advertise<std_msgs::UInt32MultiArray>(name + "/faces", kQueue),
      private_node_.advertise<geometry_msgs::WrenchStamped>(name + "/wrench", kQueue)};
  return topics_.insert({{organ, tool}, topics}).first->second;
}

void ContactAdapter::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  status.summary(DiagnosticStatus::OK, std::to_string(topics_.size()) + " pairs of organ and tool");
  if (received_ == 0) {
    status.summary(DiagnosticStatus::WARN, "nothing came yet on " + subscriber_.getTopic());
  }
  status.add("messages", received_);
  for (const std::string& sentence : parameters_.misspelt) {
    status.mergeSummary(DiagnosticStatus::WARN, sentence);
  }
  show_failures("unpublished", failures_, status);
}

}  // namespace organ_collision
