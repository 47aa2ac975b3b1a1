#include "rig.hpp"

#include <utility>

#include "stopwatch.hpp"

namespace organ_collision::bench {

Rig::Rig(std::unique_ptr<Engine> engine, const Scene& scene)
    : engine_(std::move(engine)), scene_(scene) {
  engine_->set_topology(scene.organ);
  check(scene.steps, false);
  check(scene.rigid_steps, true);
  findings_.hits /= 2.0 * static_cast<double>(scene.steps.size() + scene.rigid_steps.size());
}

void Rig::check(const std::vector<SceneStep>& steps, bool rigid) {
  for (const SceneStep& step : steps) {
    if (rigid) {
      hold_first_shape();
    } else {
      engine_->update(scene_.shapes[step.shape]);
    }
    for (const CheckedQuery* checked : {&step.fixed, &step.swept}) {
      engine_->query(checked->query, faces_);
      const Errors errors = compare(faces_, checked->answer);
      findings_.errors.missed += errors.missed;
      findings_.errors.wrong += errors.wrong;
      findings_.hits += static_cast<double>(checked->answer.faces.size());
    }
  }
}

void Rig::hold_first_shape() {
  if (!holds_first_shape_) engine_->update(scene_.shapes.front());
  holds_first_shape_ = true;
}

StepTimes Rig::step() {
  const SceneStep& step = scene_.steps[next_++ % scene_.steps.size()];
  holds_first_shape_ = false;
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
  hold_first_shape();
  StepTimes times;
  Stopwatch watch;
  engine_->query(step.fixed.query, faces_);
  times.fixed = watch.lap();
  engine_->query(step.swept.query, faces_);
  times.swept = watch.lap();
  return times;
}

}  // namespace organ_collision::bench
