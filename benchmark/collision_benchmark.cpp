#include <benchmark/benchmark.h>

#include <cstring>
#include <iostream>
#include <vector>

#include "benchmarks.hpp"
#include "reporters.hpp"

// collision_benchmark --benchmark_out=FILE [--small] [Google Benchmark's options]
// --small: nothing above 100 000 faces.
int main(int argc, char** argv) {
  using namespace organ_collision::bench;
  benchmark::Initialize(&argc, argv);
  const bool small = argc == 2 && std::strcmp(argv[1], "--small") == 0;
  if (!small && benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;

  Lab lab;
  for (const bool shuffled : {false, true}) {
    for (const std::size_t faces : {4, 1224, 10'000, 100'000, 1'000'000}) {
      if (small && faces > 100'000) continue;
      add_benchmarks(lab, {faces, shuffled});
    }
  }
  add_grasper(lab);
  add_rough_steps();
  SilentReporter display;
  PlainJsonReporter file;
  benchmark::RunSpecifiedBenchmarks(&display, &file);
  if (lab.own_errors() == 0) return 0;
  std::cerr << "the package's own pickers gave wrong answers" << std::endl;
  return 1;
}
