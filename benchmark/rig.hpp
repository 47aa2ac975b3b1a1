#pragma once

#include <memory>
#include <vector>

#include "engine.hpp"
#include "scene.hpp"

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
  /// Checks all answers before anything is timed. `scene` outlives the rig.
  Rig(std::unique_ptr<Engine> engine, const Scene& scene);

  const Findings& findings() const { return findings_; }
  /// A new shape, then both queries.
  StepTimes step();
  /// The organ takes its first shape, for rigid steps; not timed.
  void hold_first_shape() { engine_->update(scene_.shapes.front()); }
  /// Both queries, the organ as it is.
  StepTimes rigid_step();

 private:
  void check(const SceneStep& step);

  std::unique_ptr<Engine> engine_;
  const Scene& scene_;
  Findings findings_;
  std::vector<std::uint32_t> faces_;
  std::size_t next_ = 0;
};

}  // namespace organ_collision::bench
