#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Empty.h>

#include <functional>
#include <vector>

#include "ros/parameters/node_parameters.hpp"
#include "ros/pipeline/collision_pipeline.hpp"
#include "ros/publishing/contact_publisher.hpp"
#include "ros/publishing/diagnostics.hpp"
#include "ros/publishing/node_counters.hpp"
#include "ros/steps/query_services.hpp"
#include "ros/steps/wait_clock.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// The node. It connects the topics with the pipeline, and the pipeline with the publishers
/// (doc/architecture.md). One thread does all work through one callback queue. That thread owns the
/// GL context and all state, so that the state needs no locks. Only large meshes with new triangles
/// are built in a second thread (organ_message_queue.hpp).
class CollisionNode {
 public:
  /// Throws ParameterError and GlError. The same thread must call run().
  CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// Works until ROS shuts down or `stop` returns true. Throws an exception that the node cannot
  /// recover from, such as std::bad_alloc, after it has published PICKER_FAILED for each organ and
  /// tool.
  void run(const std::function<bool()>& stop = [] { return false; });

 private:
  void report_last_diagnostics();
  void receive();
  ros::WallDuration wait(SteadyTime now) const;
  bool call_one(ros::WallDuration wait);
  void guard(const std::function<void()>& action);
  bool on_reset(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  LoadedParameters loaded_;
  std::vector<Tool> tools_;
  NodeCounters counters_;

  ContactPublisher publisher_;
  CollisionPipeline pipeline_;
  WaitClock wait_clock_;
  SteadyTime heard_until_;  ///< all messages that came before have been handled
  QueryServices services_;
  Diagnostics diagnostics_;
  diagnostic_updater::Updater updater_;

  ros::ServiceServer reset_;
  ros::Timer tick_;
  ros::WallTimer diagnostic_timer_;
};

}  // namespace organ_collision
