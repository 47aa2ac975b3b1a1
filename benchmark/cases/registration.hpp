#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

#include "benchmark/measurements/measurement_cache.hpp"

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
