#pragma once

#include <benchmark/benchmark.h>

#include <vector>

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
