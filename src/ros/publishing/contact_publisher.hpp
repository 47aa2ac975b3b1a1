#pragma once

#include "diagnostics.hpp"

namespace organ_collision {

/// Publishes the answers of steps on `contacts`. Counts the answers and the accepted shapes.
class ContactPublisher {
 public:
  /// `tools` and `counters` must outlive this.
  ContactPublisher(ros::NodeHandle private_node, const std::vector<Tool>& tools,
                   NodeCounters& counters);

  void publish(const ToolStep& step);
  /// Counts an accepted shape. If the message brought no shape, publishes for each tool an answer
  /// that says why.
  void report(const OrganUpdate& update);
  /// Publishes PICKER_FAILED for each organ and tool: subscribers must not take the silence of a
  /// node that broke down for the absence of contacts.
  void report_breakdown(const OrganRegistry& organs, const std::string& why);

 private:
  void publish_failure(const Tool& tool, const std::string& organ, const std_msgs::Header& header,
                       std::uint8_t status, const std::string& message);

  const std::vector<Tool>& tools_;
  NodeCounters& counters_;
  ros::Publisher contacts_;
};

}  // namespace organ_collision
