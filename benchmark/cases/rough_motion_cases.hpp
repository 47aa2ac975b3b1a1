#pragma once

#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision::bench {

/// Times a swept query whose motion is not smooth: the simulator glitches or the hand trembles.
class RoughMotionMeasurement {
 public:
  enum class Organ {
    kRests,
    kGlitches,  ///< one vertex, far from the tool, jumps by 0.1 m
    kJumps      ///< all vertices jump by 0.1 m
  };
  enum class Tool { kShaft, kGrasper };

  /// The tool is in contact with an organ of `faces` faces. It rests, except for a tremor of 0.05
  /// mm (standard deviation along each axis) at each of the `samples` poses of its path.
  RoughMotionMeasurement(std::size_t faces, Organ organ, Tool tool, std::size_t samples);

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
