#include "rig.hpp"

#include <utility>

#include "stopwatch.hpp"

namespace organ_collision::bench {

Rig::Rig(std::unique_ptr<Engine> engine, const Scene& scene)
    : engine_(std::move(engine)), scene_(scene) {
  engine_->set_topology(scene.organ);
  for (const SceneStep& step : scene.steps) {
    engine_->update(scene.shapes[step.shape]);
    check(step);
  }
  hold_first_shape();
  for (const SceneStep& step : scene.rigid_steps) check(step);
  findings_.hits /= 2.0 * static_cast<double>(scene.steps.size() + scene.rigid_steps.size());
}

void Rig::check(const SceneStep& step) {
  for (const CheckedQuery* checked : {&step.fixed, &step.swept}) {
    engine_->query(checked->query, faces_);
    const Errors errors = compare(faces_, checked->answer);
    findings_.errors.missed += errors.missed;
    findings_.errors.wrong += errors.wrong;
    findings_.hits += static_cast<double>(checked->answer.faces.size());
  }
}

StepTimes Rig::step() {
  const SceneStep& step = scene_.steps[next_++ % scene_.steps.size()];
  StepTimes times;
  Stopwatch watch;
  engine_->update(scene_.shapes[step.shape]);
  times.update = watch.lap();
  engine_->query(step.fixed.query, faces_);
  times.fixed = watch.lap();
  engine_->query(step.swept.query, faces_);
  times.swept = watch.lap();
  return times;
}

StepTimes Rig::rigid_step() {
  const SceneStep& step = scene_.rigid_steps[next_++ % scene_.rigid_steps.size()];
  StepTimes times;
  Stopwatch watch;
  engine_->query(step.fixed.query, faces_);
  times.fixed = watch.lap();
  engine_->query(step.swept.query, faces_);
  times.swept = watch.lap();
  return times;
}

}  // namespace organ_collision::bench
