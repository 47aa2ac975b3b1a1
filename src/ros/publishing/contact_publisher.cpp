#include "contact_publisher.hpp"

#include <ros/console.h>

#include <boost/make_shared.hpp>

#include "organ_collision/ros/names.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// [messages] The queue of a subscriber that reads more slowly than the node publishes.
constexpr std::uint32_t kQueue = 100;

}  // namespace

ContactPublisher::ContactPublisher(ros::NodeHandle private_node, const std::vector<Tool>& tools,
                                   NodeCounters& counters)
    : tools_(tools),
      counters_(counters),
      contacts_(private_node.advertise<ContactArray>(names::kContacts, kQueue)) {}

void ContactPublisher::publish(const ToolStep& step) {
  if (step.is_starting) {
    ++counters_.starting;
    ROS_DEBUG("%s", step.answer->message.c_str());
  } else {
    count_failure(counters_.failed, step.answer->status, step.answer->message);
  }
  if (step.answer->path_incomplete) {
    counters_.incomplete.add("path not wholly known",
                             "tool '" + step.answer->tool + "': " + step.answer->message,
                             SteadyClock::now());
  }
  if (step.answer->status == ContactArray::OK) counters_.query_times.add(step.query_sec);
  contacts_.publish(step.answer);
  ++counters_.published;
  counters_.contacts.count();
}

void ContactPublisher::report(const OrganUpdate& update) {
  if (update.status == ContactArray::OK) return counters_.meshes.count();
  for (const Tool& tool : tools_) {
    publish_failure(tool, update.message.organ(), update.message.header(), update.status,
                    update.why_not);
  }
}

void ContactPublisher::report_breakdown(const OrganRegistry& organs, const std::string& why) {
  const std::string message =
      "the node broke down: " + why + "; once it is back, send the organs again";
  count_failure(counters_.failed, ContactArray::PICKER_FAILED, message);
  for (const auto& [name, organ] : organs.organs()) {
    std_msgs::Header header;
    header.frame_id = organ.frame();
    for (const Tool& tool : tools_) {
      publish_failure(tool, name, header, ContactArray::PICKER_FAILED, message);
    }
  }
}

void ContactPublisher::publish_failure(const Tool& tool, const std::string& organ,
                                       const std_msgs::Header& header, std::uint8_t status,
                                       const std::string& message) {
  contacts_.publish(boost::make_shared<ContactArray>(
      failed_answer(organ, tool.parameters, header, status, message)));
  ++counters_.published;
}

}  // namespace organ_collision
