#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Empty.h>

#include <functional>
#include <vector>

#include "background_thread.hpp"
#include "ros/motion/pose_topics.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/motion/transform_topics.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/organs/organ_services.hpp"
#include "ros/organs/organ_topics.hpp"
#include "ros/organs/surface_inspector.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/publishing/contact_publisher.hpp"
#include "ros/publishing/diagnostics.hpp"
#include "ros/publishing/node_counters.hpp"
#include "ros/steps/contact_query.hpp"
#include "ros/steps/query_services.hpp"
#include "ros/steps/step_scheduler.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// The node. It connects the rooms of this library, each of which hands its results on to the next:
/// topics -> organs and motion -> steps -> publishing (doc/architecture.md). One thread does all
/// work through one callback queue. That thread owns the GL context and all state, so that the
/// state needs no locks. Only large meshes with new triangles are built in a second thread
/// (organ_message_queue.hpp), and their surfaces are inspected in a third one, the background
/// thread (surface_inspector.hpp).
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
  bool call_one(ros::WallDuration wait);
  void apply_organ_messages();
  void guard(const std::function<void()>& action);
  void watch_clock();
  bool on_reset(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);

  ros::CallbackQueue queue_;
  BackgroundThread background_;
  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  LoadedParameters loaded_;
  std::vector<Tool> tools_;
  NodeCounters counters_;

  OrganRegistry organs_;
  TransformBuffer transforms_;
  ToolPoses poses_;
  ContactQuery contact_query_;
  ContactPublisher publisher_;
  StepScheduler steps_;
  QueryServices services_;
  Diagnostics diagnostics_;
  diagnostic_updater::Updater updater_;

  OrganTopics organ_topics_;
  SurfaceInspector surfaces_;
  OrganServices organ_services_;
  TransformTopics transform_topics_;
  PoseTopics pose_topics_;
  ros::ServiceServer reset_;
  ros::Timer tick_;
  ros::WallTimer diagnostic_timer_;
  ros::Time last_now_;
};

}  // namespace organ_collision
