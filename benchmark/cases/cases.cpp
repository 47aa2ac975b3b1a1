#include "cases.hpp"

namespace organ_collision::bench {

std::string case_name(const std::string& part, const std::string& engine, const SceneKey& key) {
  return part + "/" + engine + "/" + std::to_string(key.faces) + (key.shuffled ? "/shuffled" : "");
}

void add_case(const std::string& name, std::size_t steps,
              const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->UseManualTime()
      ->Iterations(static_cast<benchmark::IterationCount>(steps))
      ->Unit(benchmark::kMicrosecond);
}

void count_errors(const CheckSummary& summary, benchmark::State& state) {
  state.counters["hits"] = summary.hits;
  state.counters["missed"] = static_cast<double>(summary.errors.missed);
  state.counters["wrong"] = static_cast<double>(summary.errors.wrong);
}

}  // namespace organ_collision::bench
