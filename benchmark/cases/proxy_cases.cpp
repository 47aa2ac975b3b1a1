#include "benchmark/measurements/durations.hpp"
#include "benchmark/measurements/proxy_measurement.hpp"
#include "cases.hpp"
#include "registration.hpp"

namespace organ_collision::bench {
namespace {

constexpr double kDepth = 0.005;   // [m] of a hand that slides below the surface
constexpr double kHeight = -0.02;  // [m] of a hand that flies above it

struct TaskEntry {
  const char* part;
  ProxyTask task;
};

constexpr TaskEntry kTasks[] = {
    {"proxy_slide", {HandTool::kTrocar, kDepth, false, 1224}},
    {"proxy_slide", {HandTool::kTrocar, kDepth, false, 10'000}},
    {"proxy_slide", {HandTool::kTrocar, kDepth, false, 100'000}},
    {"proxy_slide_moving", {HandTool::kTrocar, kDepth, true, 1224}},
    {"proxy_slide_moving", {HandTool::kTrocar, kDepth, true, 10'000}},
    {"proxy_slide_moving", {HandTool::kTrocar, kDepth, true, 100'000}},
    {"proxy_flight_moving", {HandTool::kTrocar, kHeight, true, 1224}},
    {"proxy_flight_moving", {HandTool::kTrocar, kHeight, true, 100'000}},
    {"proxy_shaft_moving", {HandTool::kShaft, kDepth, true, 1224}},
    {"proxy_ball_moving", {HandTool::kBall, kDepth, true, 1224}},
    {"proxy_grasper_moving", {HandTool::kGrasper, kDepth, true, 1224}},
};

struct EngineEntry {
  const char* name;
  ProxyMeasurement::Tick (ProxyMeasurement::*tick)();
};

constexpr EngineEntry kEngines[] = {{"ours", &ProxyMeasurement::follow},
                                    {"penalty", &ProxyMeasurement::penalty}};

/// Whole laps, so that each repetition goes on where the last one of the same engine ended. The
/// 99.9th percentile wants thousands of ticks.
std::size_t ticks_per_repetition(std::size_t faces) { return (faces < 100'000 ? 5 : 2) * kLap; }

/// Adds quantiles in microseconds.
void count_durations(const Durations& answers, const Durations& updates, benchmark::State& state) {
  constexpr double kMicro = 1e6;
  state.counters["median"] = kMicro * answers.quantile(0.5);
  state.counters["p99"] = kMicro * answers.quantile(0.99);
  state.counters["p99_9"] = kMicro * answers.quantile(0.999);
  state.counters["update"] = kMicro * updates.quantile(0.5);
}

}  // namespace

void add_proxy_cases(MeasurementCache& cache) {
  for (const TaskEntry& entry : kTasks) {
    for (const EngineEntry& engine : kEngines) {
      const auto run = [&cache, entry, engine](benchmark::State& state) {
        ProxyMeasurement& measurement = cache.proxy(entry.part, entry.task);
        Durations answers, updates;
        for ([[maybe_unused]] const auto _ : state) {
          const ProxyMeasurement::Tick tick = (measurement.*engine.tick)();
          state.SetIterationTime(tick.answer);
          answers.add(tick.answer);
          updates.add(tick.update);
        }
        count_durations(answers, updates, state);
        state.counters["contacts"] = measurement.summary().hits;
        state.counters["held"] = measurement.held();
      };
      add_case(case_name(entry.part, engine.name, {entry.task.faces, false}),
               ticks_per_repetition(entry.task.faces), run);
    }
  }
}

}  // namespace organ_collision::bench
