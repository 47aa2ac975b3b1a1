#include "collision_pipeline.hpp"

namespace organ_collision {

CollisionPipeline::CollisionPipeline(const NodeParameters& parameters,
                                     const std::vector<Tool>& tools, FailureLog& rejected,
                                     Callbacks callbacks,
                                     std::optional<OrganIntake::Threads> threads)
    : inbox(
          parameters, rejected, [this](std::size_t tool) { steps.add_pose(tool); }, threads),
      poses(inbox.transforms, {parameters.motion_sample_sec, parameters.motion_samples_max}),
      workers(parameters),
      steps(parameters, tools, inbox.organs, poses, workers, callbacks.step),
      callbacks_(std::move(callbacks)) {}

void CollisionPipeline::apply_organ_messages(SteadyTime now) {
  while (const auto update = inbox.intake.next()) {
    steps.add(*update, now);
    callbacks_.update(*update);
  }
}

}  // namespace organ_collision
