#include "proxy_cases.hpp"

#include <utility>

#include "cases.hpp"
#include "query/make_request.hpp"

namespace organ_collision::bench {

ProxyMeasurement::ProxyMeasurement(const ProxyTask& task)
    : task_(task),
      tool_(make_proxy_tool(task.tool)),
      lap_(sliding_lap(task.tool, task.depth)),
      organ_(task.faces),
      shapes_{std::make_shared<TriangleMesh>(organ_.middle().vertices, organ_.middle().triangles)},
      topology_(shapes_[0]->faces(), shapes_[0]->vertices()),
      proxy_(tool_, {}) {
  shapes_[1] = task.is_moving ? std::make_shared<TriangleMesh>(*shapes_[0]) : shapes_[0];
  check();
}

/// Gives the organ the shape of this tick, and returns how long this took [s].
double ProxyMeasurement::move_organ() {
  if (!task_.is_moving) return 0.0;
  std::swap(shapes_[0], shapes_[1]);
  const SharedVertices vertices = organ_.shape(tick_);
  Stopwatch watch;
  shapes_[0]->move_vertices(vertices);
  return watch.lap();
}

CollisionRequest ProxyMeasurement::request(ToolPath path, QueryMode mode) const {
  return make_request({shapes_[0].get(), shapes_[1].get()}, {tool_.radius, &tool_.links}, {mode},
                      std::move(path));
}

ProxyMeasurement::Tick ProxyMeasurement::follow() {
  const double update = move_organ();
  const ToolPose& hand = lap_[tick_++ % kLap];
  const std::vector<ProxyOrgan> organs = this->organs();
  Stopwatch watch;
  proxy_.follow(hand, organs);
  return {update, watch.lap()};
}

ProxyMeasurement::Tick ProxyMeasurement::penalty() {
  const double update = move_organ();
  const ToolPose& from = lap_[tick_ % kLap];
  const ToolPose& to = lap_[++tick_ % kLap];
  const CollisionRequest swept =
      request({{0.0, from.axis, from.links}, {1.0, to.axis, to.links}}, QueryMode::kSwept);
  Stopwatch watch;
  query_.evaluate(swept, result_);
  return {update, watch.lap()};
}

void ProxyMeasurement::check() {
  for (std::size_t i = 0; i < kLap; ++i) {
    move_organ();
    const ProxyAnswer& answer = proxy_.follow(lap_[tick_++ % kLap], organs());
    query_.evaluate(request(resting_path(answer.proxy), QueryMode::kStatic), result_);
    summary_.errors.wrong += !result_.contacts.empty() && answer.state != ProxyStatus::kSqueezed;
    summary_.hits += static_cast<double>(answer.contacts.size()) / kLap;
    held_ += (answer.state != ProxyStatus::kFree) / static_cast<double>(kLap);
  }
}

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
