#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "ros/messages/conversions.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/motion/motion_topics.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/organs/organ_intake.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/parameters/tool_parameters.hpp"

namespace organ_collision {

/// What a node knows of organs and of motion: the receivers of its topics, and what their messages
/// said. Without subscribe(), it needs no ROS master. All functions must be called in one thread.
class Inbox {
 public:
  /// Where messages are noted; all must outlive this.
  struct Sinks {
    std::function<void(std::size_t tool)> pose;  ///< called after each pose of a tip from a topic
    FailureLog& rejected;                        ///< counts the messages that were refused
    ros::CallbackQueueInterface& callbacks;      ///< gets a callback when a mesh was built
  };

  /// What is refused.
  struct Limits {
    int max_faces;         ///< of an organ
    double max_ahead_sec;  ///< of a stamp before the clock
  };

  Inbox(const Limits& limits, const std::vector<ToolParameters>& tools, const Sinks& sinks);

  /// Subscribes to the topics of organs, of TF and of poses.
  void subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  /// The receivers. They also take messages from elsewhere than topics.
  OrganTopics& organ_topics() { return organ_topics_; }
  TransformTopics& transform_topics() { return transform_topics_; }
  PoseTopics& pose_topics() { return pose_topics_; }

  /// If ROS time jumped back since the last call, forgets all history and returns true. The same if
  /// stamps step back soon after a jump (what was taken before was on its way during the jump), and
  /// if simulated time begins long before the stamps of what was taken. Call it before and after
  /// each message, so that no message and no step meets state from before the jump.
  bool watch_clock();
  /// Forgets all transforms but the static ones, and all that is known of the past of the organs.
  void forget_history();

  const OrganRegistry& organs() const { return organs_; }
  TransformBuffer& transforms() { return transforms_; }
  const TransformBuffer& transforms() const { return transforms_; }

 private:
  /// [s] of ROS time: what was on its way during a jump has arrived by then.
  static constexpr double kArrival = 2.0;
  /// No more often after a jump: a frame with two senders may step back again and again.
  static constexpr int kMostForgotten = 3;

  bool is_too_far_ahead(ros::Time stamp, ros::Time now) const;

  double max_ahead_sec_;
  double jumped_ = -kArrival;  ///< [s] when the clock jumped back last
  int may_forget_ = 0;  ///< how often transforms that were on their way may still be forgotten
  OrganRegistry organs_;
  TransformBuffer transforms_;
  OrganTopics organ_topics_;
  TransformTopics transform_topics_;
  PoseTopics pose_topics_;
  ClockWatch clock_;
};

}  // namespace organ_collision
