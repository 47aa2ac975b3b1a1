#pragma once

#include "benchmark/rigs/lab.hpp"

namespace organ_collision::bench {

/// Registers `<part>/<engine>/<faces>`, with "/shuffled" behind it for a mesh in random order: all
/// parts of all engines on one scene. `lab` outlives their run.
void add_benchmarks(Lab& lab, const SceneKey& key);
/// Those of a grasper of four links.
void add_grasper(Lab& lab);
/// Those of steps that are not smooth.
void add_rough_steps();

}  // namespace organ_collision::bench
