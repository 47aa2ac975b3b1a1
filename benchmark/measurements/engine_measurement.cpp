#include "engine_measurement.hpp"

#include <utility>

#include "stopwatch.hpp"

namespace organ_collision::bench {

EngineMeasurement::EngineMeasurement(std::unique_ptr<Engine> engine, const Scene& scene, bool rigid)
    : engine_(std::move(engine)),
      scene_(scene),
      steps_(rigid ? scene.rigid_steps : scene.steps),
      rigid_(rigid) {
  const SharedVertices& first = scene.shapes.front();
  engine_->set_topology(scene.organ, rigid ? *first : scene.organ.vertices);
  engine_->update(first);
  for (const SceneStep& step : steps_) check(step);
  summary_.hits /= 2.0 * static_cast<double>(steps_.size());
}

void EngineMeasurement::check(const SceneStep& step) {
  if (!rigid_) engine_->update(scene_.shapes[step.shape]);
  for (const CheckedQuery* checked : {&step.static_query, &step.swept_query}) {
    engine_->query(checked->query, faces_);
    summary_.add(compare(faces_, checked->answer));
    summary_.hits += static_cast<double>(checked->answer.faces.size());
  }
}

const StepTimes& EngineMeasurement::times(std::size_t i) {
  while (times_.size() <= i) times_.push_back(run(steps_[times_.size() % steps_.size()]));
  return times_[i];
}

StepTimes EngineMeasurement::run(const SceneStep& step) {
  StepTimes times;
  Stopwatch watch;
  if (!rigid_) {
    engine_->update(scene_.shapes[step.shape]);
    times.update = watch.lap();
  }
  engine_->query(step.static_query.query, faces_);
  times.static_query = watch.lap();
  engine_->query(step.swept_query.query, faces_);
  times.swept_query = watch.lap();
  return times;
}

}  // namespace organ_collision::bench
