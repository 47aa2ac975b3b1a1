#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Empty.h>

#include <functional>

#include "ros/motion/pose_topics.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/motion/transform_topics.hpp"
#include "ros/organs/organ_message_queue.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/publishing/diagnostics.hpp"
#include "ros/steps/contact_query.hpp"
#include "ros/steps/query_services.hpp"
#include "ros/steps/step_scheduler.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// The node: wires topics, services, TF and timers to the evaluation. One thread does everything,
/// through one callback queue: it owns the GL context, there are no locks, and a transform that
/// arrives wakes what waits for it. Only large new meshes are made in another
/// (organ_message_queue.hpp).
class CollisionNode {
 public:
  /// Throws ParameterError, GlError. The calling thread must be the one that runs it.
  CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// Works until ROS shuts down or `stop` says so. Throws what it cannot go on from, such as
  /// std::bad_alloc; before that, it answers PICKER_FAILED for each organ and tool.
  void run(const std::function<bool()>& stop = [] { return false; });

 private:
  void call_callbacks();
  bool call_one(ros::WallDuration wait);
  void guard(const std::function<void()>& callback);
  void watch_clock();
  void evaluate();
  void tip_moved(std::size_t tool);

  OrganMessageQueue::Callbacks inbox_callbacks();
  template <typename Message>
  void change_organ(const Message& message, const std::function<OrganChange(ros::Time)>& apply);
  bool on_query(QueryCollision::Request& request, QueryCollision::Response& response);
  bool on_query_batch(QueryCollisionBatch::Request& request,
                      QueryCollisionBatch::Response& response);
  bool on_reset(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);

  void publish(const EvaluatedStep& step);
  void publish_failure(const std::string& organ, const std_msgs::Header& header,
                       std::uint8_t status, const std::string& message);
  void publish_failure(const Tool& tool, const std::string& organ, const std_msgs::Header& header,
                       std::uint8_t status, const std::string& message);
  void publish_breakdown(const std::string& why);

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  LoadedParameters loaded_;
  std::vector<Tool> tools_;
  NodeCounters counters_;

  TransformBuffer transforms_;
  OrganRegistry organs_;
  ToolPoses poses_;
  ContactQuery contact_query_;
  StepScheduler steps_;
  QueryServices services_;
  Diagnostics diagnostics_;
  diagnostic_updater::Updater updater_;

  ros::Time last_now_;
  bool tick_is_due_ = false;
  std::vector<char> tool_is_due_;  ///< its tip moved

  ros::Publisher contacts_;
  ros::Publisher markers_;
  TransformTopics transform_topics_;
  PoseTopics pose_topics_;
  OrganMessageQueue inbox_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> servers_;
  ros::Timer tick_;
  ros::WallTimer diagnostic_timer_;
};

}  // namespace organ_collision
