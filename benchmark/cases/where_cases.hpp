#pragma once

#include <memory>
#include <vector>

#include "benchmark/engines/engine.hpp"
#include "benchmark/scenes/scene.hpp"
#include "timing.hpp"

namespace organ_collision::bench {

/// The tools whose place is asked for: those of the scene's steps at their ends, of which every
/// second, third and fourth one is drawn back along its axis. So they pierce the organ, or their
/// tips are about 5, 15 or 40 mm away from it.
std::vector<ShaftAxis> where_axes(const Scene& scene);

/// Times a locator on the steps of a scene: an update and a location of the tool.
class WhereMeasurement {
 public:
  /// Checks the locations of the first steps against brute force before anything is timed. `scene`
  /// must outlive this object.
  WhereMeasurement(std::unique_ptr<Locator> locator, const Scene& scene);

  /// Counts wrong locations as wrong faces. `hits`: the share of tips inside.
  const CheckSummary& summary() const { return summary_; }
  /// How long the next step took [s].
  double step();

 private:
  void check(std::size_t i);

  std::unique_ptr<Locator> locator_;
  const Scene& scene_;
  std::vector<ShaftAxis> axes_;
  CheckSummary summary_;
  std::size_t next_ = 0;
};

}  // namespace organ_collision::bench
