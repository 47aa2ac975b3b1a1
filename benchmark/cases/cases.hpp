#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

#include "measurement_cache.hpp"

namespace organ_collision::bench {

/// `<part>/<engine>/<faces>`, followed by "/shuffled" if the mesh is in random order. report.py
/// reads these names.
std::string case_name(const std::string& part, const std::string& engine, const SceneKey& key);

/// Registers a benchmark whose repetitions have `steps` iterations. `run` times each one itself.
void add_case(const std::string& name, std::size_t steps,
              const std::function<void(benchmark::State&)>& run);

/// Adds the counters of a measurement's check to its benchmark.
void count_errors(const CheckSummary& summary, benchmark::State& state);

}  // namespace organ_collision::bench

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

}  // namespace organ_collision::bench
