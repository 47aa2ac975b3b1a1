#include "collision_pipeline.hpp"

#include <utility>

namespace organ_collision {

CollisionPipeline::CollisionPipeline(const NodeParameters& parameters,
                                     const std::vector<Tool>& tools, FailureLog& rejected,
                                     Callbacks callbacks,
                                     std::optional<OrganIntake::Threads> threads)
    : inbox(
          {parameters.max_faces, parameters.max_ahead_sec}, parameters.tools, rejected,
          [this](std::size_t tool) { steps.add_pose(tool); }, threads),
      poses(inbox.transforms, {parameters.motion_sample_sec, parameters.motion_samples_max}),
      workers(parameters),
      steps(parameters, tools, inbox.organs, poses, workers, std::move(callbacks.step)),
      update_(std::move(callbacks.update)) {}

void CollisionPipeline::watch_clock() {
  if (inbox.watch_clock()) steps.start_anew();
}

void CollisionPipeline::apply_organ_messages(SteadyTime now) {
  while (const auto update = inbox.intake.next()) {
    steps.add(*update, now);
    update_(*update);
  }
}

void CollisionPipeline::reset() {
  inbox.forget_history();
  steps.reset();
}

}  // namespace organ_collision
