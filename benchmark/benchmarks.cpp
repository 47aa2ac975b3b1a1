#include "benchmarks.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "benchmark/rigs/rough_steps.hpp"
#include "benchmark/rigs/stopwatch.hpp"
#include "benchmark/rigs/vertex_pass.hpp"

namespace organ_collision::bench {
namespace {

struct EngineEntry {
  const char* name;
  std::unique_ptr<Engine> (*make)();
  std::size_t max_faces;  ///< beyond them a step takes seconds
  double face_seconds;    ///< roughly what a step takes for each face
};

constexpr std::size_t kAll = 1'000'000;
constexpr EngineEntry kEngines[] = {
    {"ours", make_ours, kAll, 1e-9},
    {"ours_no_clusters", make_ours_no_clusters, kAll, 2e-9},
    {"select_paper", make_select_paper, 100'000, 3e-6},
    {"fcl", make_fcl, kAll, 1e-7},
    {"bullet", make_bullet_quantized, kAll, 1e-7},
    {"bullet_gimpact", make_bullet_gimpact, kAll, 1e-7},
    {"embree", make_embree, kAll, 5e-8},
    {"cgal", make_cgal, kAll, 1e-6},
    {"scan", make_scan, kAll, 2e-9},
};

struct PartEntry {
  const char* name;
  bool rigid;
  double (*share)(const StepTimes&);
};

constexpr PartEntry kParts[] = {
    {"update", false, [](const StepTimes& t) { return t.update; }},
    {"static", false, [](const StepTimes& t) { return t.fixed; }},
    {"swept", false, [](const StepTimes& t) { return t.swept; }},
    {"step", false, [](const StepTimes& t) { return t.update + t.fixed + t.swept; }},
    {"static_rigid", true, [](const StepTimes& t) { return t.fixed; }},
    {"swept_rigid", true, [](const StepTimes& t) { return t.swept; }},
};

struct ContactPartEntry {
  const char* name;
  bool organ_moves;
  ContactRig::Timed (ContactRig::*run)(bool);
};

constexpr ContactPartEntry kContactParts[] = {
    {"contacts", false, &ContactRig::contacts},
    {"contacts_moving", true, &ContactRig::contacts},
    {"step_contacts", false, &ContactRig::step},
    {"step_moving", true, &ContactRig::step},
};

std::string name_of(const std::string& part, const std::string& engine, const SceneKey& key) {
  return part + "/" + engine + "/" + std::to_string(key.faces) + (key.shuffled ? "/shuffled" : "");
}

// A repetition is a round through the scene's steps; slow engines take fewer. Set here, since
// Google Benchmark would repeat what takes no time, such as an update that only keeps a pointer,
// until it has added up to some, with the rest of the step each time.
std::size_t steps_a_repetition(std::size_t faces, double face_seconds) {
  constexpr double kSeconds = 0.05;
  const double affordable = kSeconds / (face_seconds * static_cast<double>(faces));
  const double round = static_cast<double>(step_count(faces));
  return static_cast<std::size_t>(std::clamp(affordable, 1.0, round));
}

void add(const std::string& name, std::size_t steps,
         const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->UseManualTime()
      ->Iterations(static_cast<benchmark::IterationCount>(steps))
      ->Unit(benchmark::kMicrosecond);
}

void report(const Findings& findings, benchmark::State& state) {
  state.counters["hits"] = findings.hits;
  state.counters["missed"] = static_cast<double>(findings.errors.missed);
  state.counters["wrong"] = static_cast<double>(findings.errors.wrong);
}

void add_engine(Lab& lab, const EngineEntry& engine, const SceneKey& key) {
  for (const PartEntry& part : kParts) {
    const auto run = [&lab, engine, part, key,
                      next = std::size_t{0}](benchmark::State& state) mutable {
      Rig& rig = lab.rig(engine.name, engine.make, key, part.rigid);
      for ([[maybe_unused]] const auto _ : state) {
        state.SetIterationTime(part.share(rig.times(next++)));
      }
      report(rig.findings(), state);
    };
    add(name_of(part.name, engine.name, key), steps_a_repetition(key.faces, engine.face_seconds),
        run);
  }
}

void add_contacts(Lab& lab, const SceneKey& key) {
  for (const ContactPartEntry& part : kContactParts) {
    const auto run = [&lab, part, key](benchmark::State& state) {
      ContactRig& rig = lab.contact_rig(key);
      std::size_t contacts = 0;
      for ([[maybe_unused]] const auto _ : state) {
        const ContactRig::Timed timed = (rig.*part.run)(part.organ_moves);
        state.SetIterationTime(timed.seconds);
        contacts += timed.contacts;
      }
      report(rig.findings(), state);
      state.counters["contacts"] =
          benchmark::Counter(static_cast<double>(contacts), benchmark::Counter::kAvgIterations);
    };
    add(name_of(part.name, "ours", key), step_count(key.faces), run);
  }
}

struct GrasperPartEntry {
  const char* name;
  double (GrasperRig::*run)();
  const Findings& (GrasperRig::*findings)() const;
};

constexpr GrasperPartEntry kGrasperParts[] = {
    {"grasper_static/ours/1224", &GrasperRig::static_query, &GrasperRig::findings},
    {"grasper_swept/ours/1224", &GrasperRig::swept_query, &GrasperRig::findings},
    {"grasper_static/fcl/1224", &GrasperRig::fcl_static_query, &GrasperRig::fcl_findings},
};

// One pass over each new shape; it is all that a step of these takes.
template <typename Pass>
void add_pass(Lab& lab, const char* name, const SceneKey& key, Pass pass) {
  for (const char* part : {"update", "step"}) {
    const auto run = [&lab, key, pass](benchmark::State& state) mutable {
      const std::vector<SharedVertices>& shapes = lab.scene(key).shapes;
      std::size_t next = 0;
      for ([[maybe_unused]] const auto _ : state) {
        const std::vector<float>& shape = *shapes[next++ % shapes.size()];
        Stopwatch watch;
        pass(shape);
        state.SetIterationTime(watch.lap());
      }
    };
    add(name_of(part, name, key), step_count(key.faces), run);
  }
}

void add_passes(Lab& lab, const SceneKey& key) {
  add_pass(lab, "vertex_pass", key,
           [boxes = VertexPass()](const std::vector<float>& vertices) mutable {
             boxes.fit(vertices);
             benchmark::DoNotOptimize(boxes.low().data());
             benchmark::ClobberMemory();
           });
  add_pass(lab, "memcpy", key,
           [copy = std::vector<float>()](const std::vector<float>& vertices) mutable {
             copy.resize(vertices.size());
             std::memcpy(copy.data(), vertices.data(), vertices.size() * sizeof(float));
             benchmark::DoNotOptimize(copy.data());
             benchmark::ClobberMemory();
           });
}

struct RoughEntry {
  const char* name;
  std::size_t faces;
  RoughSteps::Organ organ;
  RoughSteps::Tool tool;
  std::size_t samples;
};

constexpr RoughEntry kRoughSteps[] = {
    {"rough_rest_shaft_2/ours/1224", 1224, RoughSteps::Organ::kRests, RoughSteps::Tool::kShaft, 2},
    {"rough_rest_shaft_100/ours/1224", 1224, RoughSteps::Organ::kRests, RoughSteps::Tool::kShaft,
     100},
    {"rough_rest_grasper_2/ours/1224", 1224, RoughSteps::Organ::kRests, RoughSteps::Tool::kGrasper,
     2},
    {"rough_rest_grasper_100/ours/1224", 1224, RoughSteps::Organ::kRests,
     RoughSteps::Tool::kGrasper, 100},
    {"rough_rest_shaft_2/ours/100000", 100'000, RoughSteps::Organ::kRests, RoughSteps::Tool::kShaft,
     2},
    {"rough_rest_shaft_100/ours/100000", 100'000, RoughSteps::Organ::kRests,
     RoughSteps::Tool::kShaft, 100},
    {"rough_glitch_shaft_2/ours/100000", 100'000, RoughSteps::Organ::kGlitches,
     RoughSteps::Tool::kShaft, 2},
    {"rough_glitch_shaft_100/ours/100000", 100'000, RoughSteps::Organ::kGlitches,
     RoughSteps::Tool::kShaft, 100},
    {"rough_glitch_grasper_100/ours/100000", 100'000, RoughSteps::Organ::kGlitches,
     RoughSteps::Tool::kGrasper, 100},
    {"rough_jump_shaft_2/ours/100000", 100'000, RoughSteps::Organ::kJumps, RoughSteps::Tool::kShaft,
     2},
    {"rough_jump_shaft_100/ours/100000", 100'000, RoughSteps::Organ::kJumps,
     RoughSteps::Tool::kShaft, 100},
    {"rough_jump_grasper_2/ours/100000", 100'000, RoughSteps::Organ::kJumps,
     RoughSteps::Tool::kGrasper, 2},
    {"rough_jump_grasper_100/ours/100000", 100'000, RoughSteps::Organ::kJumps,
     RoughSteps::Tool::kGrasper, 100},
};

}  // namespace

void add_rough_steps() {
  constexpr std::size_t kRuns = 5;
  for (const RoughEntry& entry : kRoughSteps) {
    add(entry.name, kRuns, [entry](benchmark::State& state) {
      RoughSteps steps(entry.faces, entry.organ, entry.tool, entry.samples);
      steps.run();
      std::size_t contacts = 0;
      for ([[maybe_unused]] const auto _ : state) {
        const RoughSteps::Timed timed = steps.run();
        state.SetIterationTime(timed.seconds);
        contacts = timed.contacts;
      }
      state.counters["contacts"] = static_cast<double>(contacts);
    });
  }
}

void add_benchmarks(Lab& lab, const SceneKey& key) {
  for (const EngineEntry& engine : kEngines) {
    if (key.faces <= engine.max_faces) add_engine(lab, engine, key);
  }
  add_contacts(lab, key);
  add_passes(lab, key);
}

void add_grasper(Lab& lab) {
  for (const GrasperPartEntry& part : kGrasperParts) {
    add(part.name, step_count(1224), [&lab, part](benchmark::State& state) {
      GrasperRig& rig = lab.grasper_rig();
      for ([[maybe_unused]] const auto _ : state) state.SetIterationTime((rig.*part.run)());
      report((rig.*part.findings)(), state);
    });
  }
}

}  // namespace organ_collision::bench
