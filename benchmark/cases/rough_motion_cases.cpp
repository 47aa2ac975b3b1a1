#include "rough_motion_cases.hpp"

#include <random>

#include "benchmark/scenes/grasper.hpp"
#include "benchmark/scenes/tool_motions.hpp"
#include "cases.hpp"
#include "timing.hpp"

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

constexpr double kJump = 0.1;            // [m]
constexpr double kTremor = 5e-5;         // [m] standard deviation along each axis
constexpr double kJawOpening = 0.3;      // [rad]
constexpr std::size_t kGlitching = 700;  // a vertex far from the tools, in large organs
/// Points at the end of the organ, where its faces are smallest: a grasper touches some 100 of the
/// 1224 faces there.
const ShaftAxis kTowardsEnd{{-0.0361, 0.1536, -0.0694}, {-0.0832, 0.0, 0.0}};

std::vector<float> shape_before(const OrganSurface& organ, RoughMotionMeasurement::Organ how) {
  std::vector<float> vertices = organ.vertices;
  if (how == RoughMotionMeasurement::Organ::kGlitches)
    vertices.at(3 * kGlitching) -= static_cast<float>(kJump);
  if (how == RoughMotionMeasurement::Organ::kJumps) {
    for (std::size_t i = 2; i < vertices.size(); i += 3) vertices[i] -= static_cast<float>(kJump);
  }
  return vertices;
}

ToolPath trembling_path(const ShaftAxis& axis, std::size_t samples) {
  std::mt19937 random(42);
  std::normal_distribution<double> tremor(0.0, kTremor);
  ToolPath path;
  for (std::size_t i = 0; i < samples; ++i) {
    ShaftAxis trembling = axis;
    for (int k = 0; k < 3; ++k) trembling.tip[k] += tremor(random);
    const double last = static_cast<double>(samples - 1);
    path.push_back(
        Grasper::place(last > 0.0 ? static_cast<double>(i) / last : 0.0, trembling, kJawOpening));
  }
  return path;
}

}  // namespace

RoughMotionMeasurement::RoughMotionMeasurement(std::size_t faces, Organ organ, Tool tool,
                                               std::size_t samples)
    : organ_([&] {
        const OrganSurface surface = make_organ(faces);
        return TriangleMesh(surface.vertices, surface.triangles);
      }()),
      before_(organ_),
      links_(Grasper::make_links()) {
  const OrganSurface surface = make_organ(faces);
  before_.move_vertices(shape_before(surface, organ));
  request_.organ = &organ_;
  if (organ != Organ::kRests) request_.organ_before = &before_;
  request_.mode = QueryMode::kSwept;
  request_.radius = Grasper::kRadius;
  if (tool == Tool::kGrasper) request_.links = &links_;
  const ShaftAxis axis = tool == Tool::kGrasper
                             ? kTowardsEnd
                             : ToolMotions(surface, SceneScale(1224)).next(surface.vertices).end;
  request_.path = trembling_path(axis, samples);
}

RoughMotionMeasurement::Timed RoughMotionMeasurement::run() {
  Stopwatch watch;
  query_.evaluate(request_, result_);
  return {watch.lap(), result_.contacts.size()};
}

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
