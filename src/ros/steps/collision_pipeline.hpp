#pragma once

#include "ros/motion/motion_topics.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "step_scheduler.hpp"

namespace organ_collision {

/// What a node knows of organs and of motion, and the receivers of its topics, which also take
/// messages from elsewhere. Without subscribe(), it needs no ROS master. All functions must be
/// called in one thread.
class Inbox {
 public:
  /// Refuses what exceeds the limits of the parameters. `rejected` counts the messages that were
  /// refused, and must outlive this. `arrived` is called after each pose of a tip from a topic.
  /// `threads`: see OrganIntake.
  Inbox(const OrganNodeParameters& parameters, FailureLog& rejected, MotionTopics::Arrived arrived,
        std::optional<OrganIntake::Threads> threads = {})
      : organs({static_cast<std::size_t>(parameters.max_faces)}, parameters.max_ahead_sec),
        intake(organs, rejected, threads),
        motion(parameters.tools, transforms, rejected, std::move(arrived),
               parameters.max_ahead_sec),
        max_ahead_sec_(parameters.max_ahead_sec) {}

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

/// The way from messages to answers: organs and motion -> steps (doc/architecture.md). The node
/// feeds it from topics, the program replay from a bag. Without a subscription, it needs no ROS
/// master. All functions must be called in one thread. The workers evaluate steps side by side
/// while the scheduler waits for them.
class CollisionPipeline {
 public:
  struct Callbacks {
    StepScheduler::Publish step;                     ///< gets the steps in their order
    std::function<void(const OrganUpdate&)> update;  ///< gets what each organ message did
  };

  /// `parameters`, `tools`, and `rejected`, which counts the messages that were refused, must
  /// outlive this. `threads`: see OrganIntake. Throws GlError.
  CollisionPipeline(const NodeParameters& parameters, const std::vector<Tool>& tools,
                    FailureLog& rejected, Callbacks callbacks,
                    std::optional<OrganIntake::Threads> threads = {});

  /// Inbox::watch_clock(), also for the steps.
  void watch_clock();
  /// Applies the organ messages that can be applied now. Their shapes become due.
  void apply_organ_messages(SteadyTime now);
  /// Forgets all history: the next step of every tool is static.
  void reset();

  Inbox inbox;
  ToolPoses poses;
  StepWorkers workers;
  StepScheduler steps;

 private:
  std::function<void(const OrganUpdate&)> update_;
};

}  // namespace organ_collision
