#include "rig.hpp"

#include <utility>

#include "stopwatch.hpp"

namespace organ_collision::bench {

Rig::Rig(std::unique_ptr<Engine> engine, const Scene& scene, bool rigid)
    : engine_(std::move(engine)),
      scene_(scene),
      steps_(rigid ? scene.rigid_steps : scene.steps),
      rigid_(rigid) {
  const SharedVertices& first = scene.shapes.front();
  engine_->set_topology(scene.organ, rigid ? *first : scene.organ.vertices);
  engine_->update(first);
  for (const SceneStep& step : steps_) check(step);
  findings_.hits /= 2.0 * static_cast<double>(steps_.size());
}

void Rig::check(const SceneStep& step) {
  if (!rigid_) engine_->update(scene_.shapes[step.shape]);
  for (const CheckedQuery* checked : {&step.fixed, &step.swept}) {
    engine_->query(checked->query, faces_);
    const Errors errors = compare(faces_, checked->answer);
    findings_.errors.missed += errors.missed;
    findings_.errors.wrong += errors.wrong;
    findings_.hits += static_cast<double>(checked->answer.faces.size());
  }
}

const StepTimes& Rig::times(std::size_t i) {
  while (times_.size() <= i) times_.push_back(run(steps_[times_.size() % steps_.size()]));
  return times_[i];
}

StepTimes Rig::run(const SceneStep& step) {
  StepTimes times;
  Stopwatch watch;
  if (!rigid_) {
    engine_->update(scene_.shapes[step.shape]);
    times.update = watch.lap();
  }
  engine_->query(step.fixed.query, faces_);
  times.fixed = watch.lap();
  engine_->query(step.swept.query, faces_);
  times.swept = watch.lap();
  return times;
}

}  // namespace organ_collision::bench
