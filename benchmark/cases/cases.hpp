#pragma once

#include "benchmark/measurements/measurement_cache.hpp"

/// Each function registers the benchmarks of one idea with Google Benchmark. `cache` must outlive
/// their run.
namespace organ_collision::bench {

/// All parts of a step, for each engine.
void add_engine_cases(MeasurementCache& cache, const SceneKey& key);
/// Contacts with full geometry.
void add_contact_cases(MeasurementCache& cache, const SceneKey& key);
/// Lower bounds for a step: one pass over the new vertices.
void add_vertex_pass_cases(MeasurementCache& cache, const SceneKey& key);
/// Where a tool is: its distance from the organ, and the side of its tip.
void add_where_cases(MeasurementCache& cache, const SceneKey& key);
/// A grasper with three links.
void add_grasper_cases(MeasurementCache& cache);
/// Ticks of a haptic proxy.
void add_proxy_cases(MeasurementCache& cache);
/// Motion that is not smooth.
void add_rough_motion_cases();

}  // namespace organ_collision::bench
