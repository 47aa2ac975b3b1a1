#pragma once

#include <ros/node_handle.h>

#include <optional>
#include <vector>

#include "ros/messages/conversions.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/motion/motion_topics.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/organs/organ_intake.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/parameters/tool_parameters.hpp"

namespace organ_collision {

/// What a node knows of organs and of motion, and the receivers of its topics, which also take
/// messages from elsewhere. Without subscribe(), it needs no ROS master. All functions must be
/// called in one thread.
class Inbox {
 public:
  /// What is refused.
  struct Limits {
    int max_faces;         ///< of an organ
    double max_ahead_sec;  ///< of a stamp before the clock
  };

  /// `rejected` counts the messages that were refused, and must outlive this. `arrived` is called
  /// after each pose of a tip from a topic. `threads`: see OrganIntake.
  Inbox(const Limits& limits, const std::vector<ToolParameters>& tools, FailureLog& rejected,
        MotionTopics::Arrived arrived, std::optional<OrganIntake::Threads> threads = {})
      : organs({static_cast<std::size_t>(limits.max_faces)}, limits.max_ahead_sec),
        intake(organs, rejected, threads),
        motion(tools, transforms, rejected, std::move(arrived), limits.max_ahead_sec),
        max_ahead_sec_(limits.max_ahead_sec) {}

  /// Subscribes to the topics of organs, of TF and of poses.
  void subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// If ROS time jumped back since the last call, forgets all history and returns true. The same if
  /// stamps step back soon after a jump (what was taken before was on its way during the jump), and
  /// if simulated time begins long before the stamps of what was taken. Call it before and after
  /// each message, so that no message and no step meets state from before the jump.
  bool watch_clock();
  /// Forgets all transforms but the static ones, and all that is known of the past of the organs.
  void forget_history();

  OrganRegistry organs;
  OrganIntake intake;  ///< into organs
  TransformBuffer transforms;
  MotionTopics motion;  ///< into transforms

 private:
  double max_ahead_sec_;
  double jumped_ = 0.0;  ///< [s] when the clock jumped back last
  int may_forget_ = 0;   ///< how often transforms that were on their way may still be forgotten
  ClockWatch clock_;
};

}  // namespace organ_collision
