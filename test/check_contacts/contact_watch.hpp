#pragma once

#include <organ_collision/ContactArray.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <cstdint>
#include <list>
#include <string>
#include <vector>

#include "contact_contract.hpp"
#include "ros/messages/failure_log.hpp"

namespace organ_collision {

/// Checks the answers of several topics, and logs and counts what they break. All its work is done
/// in the callbacks of the node's queue, which must be called from one thread.
class ContactWatch {
 public:
  ContactWatch(ros::NodeHandle node, ros::NodeHandle private_node,
               const std::vector<std::string>& topics);

  std::uint64_t answers() const { return answers_; }
  bool has_found() const { return !violations_.by_reason().empty(); }
  /// One line.
  std::string summary() const;

 private:
  using Event = ros::MessageEvent<const ContactArray>;

  struct Topic {
    std::string name;
    ContactContract contract = {};
    ros::Subscriber subscriber = {};
  };

  void check(Topic& topic, const Event& event);
  bool on_summary(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  std::list<Topic> topics_;
  FailureLog violations_;
  std::uint64_t answers_ = 0, successful_ = 0;
  ros::ServiceServer server_;
};

}  // namespace organ_collision
