#pragma once

#include <ros/node_handle.h>

#include <functional>

#include "node/markers/marker_publisher.hpp"
#include "node/publishing/diagnostics.hpp"
#include "node/publishing/touch_tracker.hpp"
#include "node/queries/query_services.hpp"
#include "node/steps/collision_pipeline.hpp"
#include "node_core.hpp"

namespace organ_collision {

/// The node. It connects the topics with the pipeline, and the pipeline with the publishers
/// (doc/theory/architecture.md). The thread that runs it owns all state (node_core.hpp). Work that
/// no step may wait for has threads of its own (doc/theory/architecture.md).
class CollisionNode {
 public:
  /// Throws ParameterError and GlError. The same thread must call run().
  CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// Works until ROS shuts down or `stop` returns true. Throws an exception that the node cannot
  /// recover from, such as std::bad_alloc, after it has published PICKER_FAILED for each organ and
  /// tool.
  void run(const std::function<bool()>& stop = [] { return false; }) { core_.run(stop); }

 private:
  using Core = NodeCore<NodeParameters>;

  Core::Callbacks callbacks();
  void publish(const ToolStep& step);
  void watch_ends(const ToolStep& step);
  void report(const OrganUpdate& update);
  void forget_touches(const KeptTools& kept);
  void break_down(const std::string& why);
  void publish_failure(const std::string& organ, const std_msgs::Header& header,
                       std::uint8_t status, const std::string& message);
  void start_ticks();

  /// Ends the threads that use members, before the members are destroyed.
  struct ThreadEnd {
    CollisionNode& node;
    ~ThreadEnd() {
      node.core_.end();
      node.services_.end();
      node.query_thread_.stop();
      node.batch_thread_.stop();
    }
  };

  NodeCounters counters_;
  Core core_;
  QueueThread query_thread_, batch_thread_;
  ros::Publisher contacts_, touch_events_;
  TouchTracker touches_;
  std::vector<SwapWatch> swaps_;  ///< of each tool
  MarkerPublisher markers_;
  CollisionPipeline pipeline_;
  QueryServices services_;
  ros::Timer tick_;
  ThreadEnd end_{*this};  ///< the last member, so that it is destroyed first
};

}  // namespace organ_collision
