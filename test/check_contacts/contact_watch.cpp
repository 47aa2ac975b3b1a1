#include "contact_watch.hpp"

#include <chrono>

#include "geometry/concatenate.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

/// [messages] That may wait while this program is busy. If more wait, the oldest are lost.
constexpr std::uint32_t kQueue = 10000;

}  // namespace

ContactWatch::ContactWatch(ros::NodeHandle node, ros::NodeHandle private_node,
                           const std::vector<std::string>& topics) {
  for (const std::string& name : topics) {
    Topic& topic = topics_.emplace_back(Topic{node.resolveName(name)});
    const boost::function<void(const Event&)> callback = [this, &topic](const Event& event) {
      check(topic, event);
    };
    topic.subscriber = node.subscribe<ContactArray>(name, kQueue, callback);
  }
  server_ = private_node.advertiseService("summary", &ContactWatch::on_summary, this);
}

void ContactWatch::check(Topic& topic, const Event& event) {
  const ContactArray& answer = *event.getConstMessage();
  ++answers_;
  successful_ += answer.status == ContactArray::OK;
  const Faults faults = topic.contract.check(answer, event.getPublisherName());
  for (const Fault& fault : faults.all()) {
    violations_.add(fault.rule,
                    concatenate(topic.name, ", organ '", plain_text(answer.organ, kLongestName),
                                "', tool '", plain_text(answer.tool, kLongestName), "', stamp ",
                                answer.header.stamp, ", ", fault.rule, ": ", fault.sentence),
                    std::chrono::steady_clock::now(), fault.places);
  }
}

std::string ContactWatch::summary() const {
  std::uint64_t lost = 0;
  for (const Topic& topic : topics_) lost += topic.contract.lost();
  std::string found;
  for (const auto& [rule, entry] : violations_.by_reason()) {
    found += concatenate(found.empty() ? "" : ", ", rule, " ", entry.count);
  }
  return concatenate(answers_, " answers came, ", successful_, " with status OK; ", lost,
                     " were lost on the way. Broken rules: ", found.empty() ? "none" : found);
}

bool ContactWatch::on_summary(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = !has_found();
  response.message = summary();
  return true;
}

}  // namespace organ_collision
