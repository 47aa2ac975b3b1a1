#pragma once

#include <ros/node_handle.h>
#include <std_srvs/Empty.h>

#include <exception>
#include <functional>
#include <vector>

#include "node_core.hpp"
#include "program.hpp"
#include "realtime.hpp"
#include "ros/markers/marker_publisher.hpp"
#include "ros/organs/organ_report.hpp"
#include "ros/organs/organ_services.hpp"
#include "ros/parameters/live_parameters.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/publishing/contact_publisher.hpp"
#include "ros/publishing/counters.hpp"
#include "ros/publishing/diagnostics.hpp"
#include "ros/queries/query_services.hpp"
#include "ros/steps/collision_pipeline.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// The node. It connects the topics with the pipeline, and the pipeline with the publishers
/// (doc/architecture.md). The thread that runs it owns all state (message_loop.hpp). Work that no
/// step may wait for has threads of its own (doc/threads.md).
class CollisionNode {
 public:
  /// Throws ParameterError and GlError. The same thread must call run().
  CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  ~CollisionNode();
  CollisionNode(const CollisionNode&) = delete;
  CollisionNode& operator=(const CollisionNode&) = delete;

  /// Works until ROS shuts down or `stop` returns true. Throws an exception that the node cannot
  /// recover from, such as std::bad_alloc, after it has published PICKER_FAILED for each organ and
  /// tool.
  void run(const std::function<bool()>& stop = [] { return false; });

 private:
  void start();
  void end_background();
  void report_last_diagnostics();
  void start_ticks();
  void exchange_tools(LoadedToolList& loaded, const KeptTools& kept);
  void change_parameters(const XmlRpc::XmlRpcValue& changes);
  bool on_reset(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);

  NodeCounters counters_;
  MessageLoop loop_;
  QueueThread background_, query_thread_, batch_thread_;
  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  LoadedParameters loaded_;
  Realtime realtime_;
  std::vector<Tool> tools_;
  std::exception_ptr broken_;  ///< why the node cannot go on; null: it can

  ContactPublisher publisher_;
  MarkerPublisher markers_;
  CollisionPipeline pipeline_;
  QueryServices services_;
  QueryDiagnostics query_diagnostics_;
  InboxDiagnostics inbox_diagnostics_;
  diagnostic_updater::Updater updater_;

  SurfaceInspector surfaces_;
  OrganServices organ_services_;
  ros::ServiceServer reset_;
  ros::Timer tick_;
  ros::WallTimer diagnostic_timer_;

  // What works in the background thread.
  ToolReload tool_reload_;
  LiveParameters live_parameters_;
  MasterWatch master_;
};

}  // namespace organ_collision
