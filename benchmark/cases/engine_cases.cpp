#include "engine_cases.hpp"

#include <algorithm>
#include <utility>

#include "cases.hpp"

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

namespace {

struct EngineEntry {
  const char* name;
  std::unique_ptr<Engine> (*make)();
  std::size_t max_faces;  ///< with more faces, a step takes seconds
  double face_seconds;    ///< [s] rough time of a step, divided by the number of faces
};

constexpr std::size_t kAll = 1'000'000;
constexpr EngineEntry kEngines[] = {
    {"ours", make_ours, kAll, 1e-9},
    {"ours_egl", make_ours_egl, kAll, 1e-9},
    {"cpu", make_cpu, kAll, 1e-9},
    {"select_paper", make_select_paper, 100'000, 3e-6},
    {"fcl", make_fcl, kAll, 1e-7},
    {"fcl_obb", make_fcl_obb, 1224, 1e-6},
    {"fcl_obb_rebuilt", make_fcl_obb_rebuilt, 1224, 3e-6},
    {"bullet", make_bullet_quantized, kAll, 1e-7},
    {"bullet_gimpact", make_bullet_gimpact, kAll, 1e-7},
    {"embree", make_embree, kAll, 5e-8},
    {"cgal", make_cgal, kAll, 1e-6},
    {"scan", make_scan, kAll, 2e-9},
};

struct PartEntry {
  const char* name;
  bool rigid;
  double (*share)(const StepTimes&);
};

constexpr PartEntry kParts[] = {
    {"update", false, [](const StepTimes& t) { return t.update; }},
    {"static", false, [](const StepTimes& t) { return t.static_query; }},
    {"swept", false, [](const StepTimes& t) { return t.swept_query; }},
    {"step", false, [](const StepTimes& t) { return t.update + t.static_query + t.swept_query; }},
    {"static_rigid", true, [](const StepTimes& t) { return t.static_query; }},
    {"swept_rigid", true, [](const StepTimes& t) { return t.swept_query; }},
};

// A repetition is one round through the scene's steps, or fewer steps if the engine is slow. Google
// Benchmark must not choose the number. It would repeat a part that takes almost no time (an update
// may only keep a pointer) very often, and each time the whole step would have to run.
std::size_t steps_per_repetition(std::size_t faces, double face_seconds) {
  constexpr double kSeconds = 0.05;
  const double affordable = kSeconds / (face_seconds * static_cast<double>(faces));
  const double round = static_cast<double>(step_count(faces));
  return static_cast<std::size_t>(std::clamp(affordable, 1.0, round));
}

void add_engine(MeasurementCache& cache, const EngineEntry& engine, const SceneKey& key) {
  for (const PartEntry& part : kParts) {
    const auto run = [&cache, engine, part, key,
                      next = std::size_t{0}](benchmark::State& state) mutable {
      EngineMeasurement& measurement = cache.engine(engine.name, engine.make, key, part.rigid);
      for ([[maybe_unused]] const auto _ : state) {
        state.SetIterationTime(part.share(measurement.times(next++)));
      }
      count_errors(measurement.summary(), state);
    };
    add_case(case_name(part.name, engine.name, key),
             steps_per_repetition(key.faces, engine.face_seconds), run);
  }
}

}  // namespace

void add_engine_cases(MeasurementCache& cache, const SceneKey& key) {
  for (const EngineEntry& engine : kEngines) {
    if (key.faces <= engine.max_faces) add_engine(cache, engine, key);
  }
}

}  // namespace organ_collision::bench
