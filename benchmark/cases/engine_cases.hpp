#pragma once

#include <memory>
#include <vector>

#include "benchmark/engines/engine.hpp"
#include "benchmark/scenes/scene.hpp"
#include "timing.hpp"

namespace organ_collision::bench {

/// How long the parts of one step took [s].
struct StepTimes {
  double update = 0.0;
  double static_query = 0.0;
  double swept_query = 0.0;
};

/// Times an engine on the steps of a scene, in rounds.
class EngineMeasurement {
 public:
  /// Checks all answers before anything is timed. If `rigid`, the organ stays in its first shape.
  /// `scene` must outlive this object.
  EngineMeasurement(std::unique_ptr<Engine> engine, const Scene& scene, bool rigid);

  const CheckSummary& summary() const { return summary_; }
  /// How long the i-th step took. A step runs only once, and its times are kept. Separate
  /// benchmarks report the parts of a step, but all parts come from the same run.
  const StepTimes& times(std::size_t i);

 private:
  void check(const SceneStep& step);
  StepTimes run(const SceneStep& step);

  std::unique_ptr<Engine> engine_;
  const Scene& scene_;
  const std::vector<SceneStep>& steps_;
  bool rigid_;
  CheckSummary summary_;
  std::vector<std::uint32_t> faces_;
  std::vector<StepTimes> times_;
};

}  // namespace organ_collision::bench
