#pragma once

#include "node/inbox.hpp"
#include "step_scheduler.hpp"

namespace organ_collision {

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

  /// Applies the organ messages that can be applied now. Each new shape becomes due for all tools.
  void apply_organ_messages(SteadyTime now);

  Inbox inbox;
  ToolPoses poses;
  StepWorkers workers;
  StepScheduler steps;

 private:
  const Callbacks callbacks_;
};

}  // namespace organ_collision
