#pragma once

#include "node/motion/motion_topics.hpp"
#include "node/motion/transform_buffer.hpp"
#include "step_scheduler.hpp"

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
      : organs({static_cast<std::size_t>(parameters.max_faces)}, parameters.max_ahead_sec),
        intake(organs, rejected, threads),
        motion(parameters.tools, transforms, rejected, std::move(arrived),
               parameters.max_ahead_sec),
        max_ahead_sec_(parameters.max_ahead_sec) {}

  /// Subscribes to the topics of organs, of TF and of poses.
  void subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// Forgets all history and returns true if ROS time jumped back since the last call, if stamps
  /// step back soon after a jump, because transforms from before it had arrived late, or if
  /// transforms are far ahead of the clock, because they came before simulated time began. Call it
  /// before and after each message, so that nothing meets state from before the jump.
  bool watch_clock();
  /// Forgets all transforms but the static ones, and all that is known of the past of the organs.
  void forget_history();

  OrganRegistry organs;
  OrganIntake intake;  ///< applies messages to `organs`
  TransformBuffer transforms;
  MotionTopics motion;  ///< adds the motion to `transforms`

 private:
  double max_ahead_sec_;
  ros::Time latest_;     ///< the latest time since the clock last jumped back
  double jumped_ = 0.0;  ///< [s] the ROS time to which the clock last jumped back
  int may_forget_ = 0;   ///< how often late transforms may still make the node forget history
};

/// Turns messages about organs and motion into steps with their answers
/// (doc/theory/architecture.md). The node feeds it from topics, and the program replay from a bag.
/// All functions must be called in one thread. The workers evaluate steps side by side while the
/// scheduler waits for them.
class CollisionPipeline {
 public:
  struct Callbacks {
    StepScheduler::Publish step;                     ///< gets each step with its answer, in order
    std::function<void(const OrganUpdate&)> update;  ///< gets what each organ message did
  };

  /// `rejected` counts the messages that were refused. `parameters`, `tools` and `rejected` must
  /// outlive this. `threads`: see OrganIntake. Throws GlError.
  CollisionPipeline(const NodeParameters& parameters, const std::vector<Tool>& tools,
                    FailureLog& rejected, Callbacks callbacks,
                    std::optional<OrganIntake::Threads> threads = {});

  /// See Inbox::watch_clock(). If the inbox forgets its history, the scheduler starts anew, too.
  /// Returns whether it did.
  bool watch_clock();
  /// Applies the organ messages that can be applied now. Each new shape becomes due for all tools.
  void apply_organ_messages(SteadyTime now);
  /// Forgets all history: the next step of every tool is static.
  void reset();

  Inbox inbox;
  ToolPoses poses;
  StepWorkers workers;
  StepScheduler steps;

 private:
  const Callbacks callbacks_;
};

}  // namespace organ_collision
