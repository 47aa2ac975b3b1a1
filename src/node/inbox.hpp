#pragma once

#include <ros/node_handle.h>

#include <optional>
#include <string>
#include <utility>

#include "motion/motion_topics.hpp"
#include "motion/transform_buffer.hpp"
#include "organs/organ_intake.hpp"
#include "organs/organ_registry.hpp"

namespace organ_collision {

/// The organs and the motion that a node knows of, and the receivers of its topics, which also take
/// messages from elsewhere, such as a bag. Without subscribe(), no ROS master is needed. All
/// functions must be called in one thread.
class Inbox {
 public:
  /// Messages that exceed the limits of `parameters` are refused. `rejected` counts them, and must
  /// outlive this. `arrived` is called after each pose of a tip from a topic. `threads`: see
  /// OrganIntake.
  Inbox(const OrganNodeParameters& parameters, FailureLog& rejected, MotionTopics::Arrived arrived,
        std::optional<OrganIntake::Threads> threads = {})
      : ahead(parameters.max_ahead_sec),
        organs({static_cast<std::size_t>(parameters.max_faces)}, ahead),
        intake(organs, rejected, threads),
        motion(parameters.tools, transforms, rejected, std::move(arrived), ahead) {}

  /// Subscribes to the topics of organs, of TF and of poses.
  void subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// Forgets all history if ROS time jumped back since the last call, or if transforms are far
  /// ahead of the clock, because they came before simulated time began. Call it before and after
  /// each message, so that nothing meets state from before the jump.
  void watch_clock();
  /// Another history of all organs begins, and of history(). Forgets all transforms but the static
  /// ones. `why`: as TouchEvent.reason.
  void begin_history(const std::string& why);
  /// Of everything together.
  const History& history() const { return history_; }

  AheadLimit ahead;  ///< the first member, because others refer to it
  OrganRegistry organs;
  OrganIntake intake;  ///< applies messages to `organs`
  TransformBuffer transforms;
  MotionTopics motion;  ///< adds the motion to `transforms`

 private:
  ros::Time latest_;  ///< the latest time since the clock last jumped back
  History history_;
};

}  // namespace organ_collision
