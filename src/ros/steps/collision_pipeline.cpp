#include "collision_pipeline.hpp"

namespace organ_collision {
namespace {

PathSampling sampling(const NodeParameters& parameters) {
  return {parameters.motion_sample_sec, parameters.motion_samples_max};
}

}  // namespace

CollisionPipeline::CollisionPipeline(const NodeParameters& parameters,
                                     const std::vector<Tool>& tools, const Sinks& sinks)
    : update_(sinks.update),
      inbox_(
          {parameters.max_faces, parameters.max_ahead_sec}, parameters.tools,
          {[this](std::size_t tool) { steps_.add_pose(tool); }, sinks.rejected, sinks.callbacks}),
      poses_(inbox_.transforms(), sampling(parameters)),
      workers_(parameters),
      steps_(parameters, tools, poses_, workers_, sinks.step) {}

void CollisionPipeline::watch_clock() {
  if (inbox_.watch_clock()) steps_.start_anew(inbox_.organs());
}

void CollisionPipeline::apply_organ_messages(SteadyTime now) {
  while (const auto update = inbox_.organ_topics().next()) {
    if (inspects_surfaces_ && update->status == ContactArray::OK) {
      inbox_.organs().at(update->message.organ()).surface()->find();
    }
    steps_.add(inbox_.organs(), *update, now);
    update_(*update);
  }
}

void CollisionPipeline::reset() {
  inbox_.forget_history();
  steps_.reset();
}

}  // namespace organ_collision
