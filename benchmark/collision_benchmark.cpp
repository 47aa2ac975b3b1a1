#include <benchmark/benchmark.h>

#include <cstring>
#include <iostream>
#include <vector>

#include "benchmark/cases/cases.hpp"

namespace organ_collision::bench {

/// Google Benchmark's JSON with plain names: without "/iterations:64/manual_time" at the end. The
/// measured time replaces the CPU time, because the CPU time includes work outside the timed part.
class PlainJsonReporter : public benchmark::JSONReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    std::vector<Run> plain = runs;
    for (Run& run : plain) {
      run.run_name.iterations.clear();
      run.run_name.time_type.clear();
      run.cpu_accumulated_time = run.real_accumulated_time;
    }
    JSONReporter::ReportRuns(plain);
  }
};

/// Prints nothing: report.py makes the tables from the JSON file.
class SilentReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& /*runs*/) override {}
};

}  // namespace organ_collision::bench

// collision_benchmark --benchmark_out=FILE [--small] [Google Benchmark's options]
// --small: no organ of more than 100 000 faces. Exits with 1 if the package's own answers are
// wrong.
int main(int argc, char** argv) {
  using namespace organ_collision::bench;
  benchmark::Initialize(&argc, argv);
  const bool small = argc == 2 && std::strcmp(argv[1], "--small") == 0;
  if (!small && benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;

  MeasurementCache cache;
  for (const bool shuffled : {false, true}) {
    for (const std::size_t faces : {4, 1224, 10'000, 100'000, 1'000'000}) {
      if (small && faces > 100'000) continue;
      const SceneKey key{faces, shuffled};
      add_engine_cases(cache, key);
      add_contact_cases(cache, key);
      add_vertex_pass_cases(cache, key);
      if (faces > 4 && !shuffled) add_where_cases(cache, key);
    }
  }
  add_grasper_cases(cache);
  SilentReporter display;
  PlainJsonReporter file;
  benchmark::RunSpecifiedBenchmarks(&display, &file);
  if (cache.own_errors() == 0) return 0;
  std::cerr << "the package's own pickers gave wrong answers" << std::endl;
  return 1;
}
