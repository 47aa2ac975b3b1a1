#pragma once

#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision::bench {

/// Swept queries of steps that are not smooth: a simulator that glitches, a hand that trembles.
class RoughSteps {
 public:
  enum class Organ {
    kRests,
    kGlitches,  ///< one vertex, far from the tool, jumps by 0.1 m
    kJumps      ///< all of it jumps by 0.1 m
  };
  enum class Tool { kShaft, kGrasper };

  /// The tool rests in contact with an organ of so many faces but for a tremor of 0.05 mm at each
  /// sample of its way, `samples` of them.
  RoughSteps(std::size_t faces, Organ organ, Tool tool, std::size_t samples);

  struct Timed {
    double seconds;
    std::size_t contacts;
  };
  Timed run();

 private:
  TriangleMesh organ_, before_;
  std::vector<Link> links_;
  CollisionRequest request_;
  CollisionQuery query_;
  CollisionResult result_;
};

}  // namespace organ_collision::bench
