#pragma once

#include <memory>
#include <vector>

#include "benchmark/engines/engine.hpp"
#include "benchmark/scenes/scene.hpp"

namespace organ_collision::bench {

/// What one step took [s].
struct StepTimes {
  double update = 0.0;
  double fixed = 0.0;  ///< the static query
  double swept = 0.0;
};

/// What all steps of a scene, checked against the oracle, came to.
struct Findings {
  Errors errors;
  double hits = 0.0;  ///< faces that meet the volume, on average
};

/// An engine on a scene, step after step, round and round.
class Rig {
 public:
  /// Checks all answers before anything is timed. A rigid organ stays in its first shape.
  /// `scene` outlives the rig.
  Rig(std::unique_ptr<Engine> engine, const Scene& scene, bool rigid);

  const Findings& findings() const { return findings_; }
  /// What the i-th step took. Each step is run once: its parts are reported one by one.
  const StepTimes& times(std::size_t i);

 private:
  void check(const SceneStep& step);
  StepTimes run(const SceneStep& step);

  std::unique_ptr<Engine> engine_;
  const Scene& scene_;
  const std::vector<SceneStep>& steps_;
  bool rigid_;
  Findings findings_;
  std::vector<std::uint32_t> faces_;
  std::vector<StepTimes> times_;
};

}  // namespace organ_collision::bench
