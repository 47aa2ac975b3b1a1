#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "inbox.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "step_scheduler.hpp"
#include "step_workers.hpp"

namespace organ_collision {

/// The way from messages to answers: organs and motion -> steps (doc/architecture.md). The node
/// feeds it from topics, the program replay from a bag. Without a subscription, it needs no ROS
/// master. All functions must be called in one thread. The workers evaluate steps side by side
/// while the scheduler waits for them.
class CollisionPipeline {
 public:
  struct Callbacks {
    std::function<void(const EvaluatedStep&)> step;  ///< gets the steps in their order
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
