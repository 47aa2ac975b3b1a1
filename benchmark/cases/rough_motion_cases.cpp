#include "benchmark/measurements/rough_motion_measurement.hpp"
#include "cases.hpp"
#include "registration.hpp"

namespace organ_collision::bench {
namespace {

using Organ = RoughMotionMeasurement::Organ;
using Tool = RoughMotionMeasurement::Tool;

struct MotionEntry {
  const char* name;
  std::size_t faces;
  Organ organ;
  Tool tool;
  std::size_t samples;
};

constexpr MotionEntry kMotions[] = {
    {"rough_rest_shaft_2/ours/1224", 1224, Organ::kRests, Tool::kShaft, 2},
    {"rough_rest_shaft_100/ours/1224", 1224, Organ::kRests, Tool::kShaft, 100},
    {"rough_rest_grasper_2/ours/1224", 1224, Organ::kRests, Tool::kGrasper, 2},
    {"rough_rest_grasper_100/ours/1224", 1224, Organ::kRests, Tool::kGrasper, 100},
    {"rough_rest_shaft_2/ours/100000", 100'000, Organ::kRests, Tool::kShaft, 2},
    {"rough_rest_shaft_100/ours/100000", 100'000, Organ::kRests, Tool::kShaft, 100},
    {"rough_glitch_shaft_2/ours/100000", 100'000, Organ::kGlitches, Tool::kShaft, 2},
    {"rough_glitch_shaft_100/ours/100000", 100'000, Organ::kGlitches, Tool::kShaft, 100},
    {"rough_glitch_grasper_100/ours/100000", 100'000, Organ::kGlitches, Tool::kGrasper, 100},
    {"rough_jump_shaft_2/ours/100000", 100'000, Organ::kJumps, Tool::kShaft, 2},
    {"rough_jump_shaft_100/ours/100000", 100'000, Organ::kJumps, Tool::kShaft, 100},
    {"rough_jump_grasper_2/ours/100000", 100'000, Organ::kJumps, Tool::kGrasper, 2},
    {"rough_jump_grasper_100/ours/100000", 100'000, Organ::kJumps, Tool::kGrasper, 100},
};

}  // namespace

void add_rough_motion_cases() {
  constexpr std::size_t kRuns = 5;
  for (const MotionEntry& entry : kMotions) {
    add_case(entry.name, kRuns, [entry](benchmark::State& state) {
      RoughMotionMeasurement measurement(entry.faces, entry.organ, entry.tool, entry.samples);
      measurement.run();
      std::size_t contacts = 0;
      for ([[maybe_unused]] const auto _ : state) {
        const RoughMotionMeasurement::Timed timed = measurement.run();
        state.SetIterationTime(timed.seconds);
        contacts = timed.contacts;
      }
      state.counters["contacts"] = static_cast<double>(contacts);
    });
  }
}

}  // namespace organ_collision::bench
