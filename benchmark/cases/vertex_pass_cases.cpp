#include <cstring>
#include <vector>

#include "benchmark/engines/vertex_pass.hpp"
#include "cases.hpp"
#include "timing.hpp"

namespace organ_collision::bench {
namespace {

// The pass is an update without queries, so it counts as the whole step, too.
template <typename Pass>
void add_pass(MeasurementCache& cache, const char* name, const SceneKey& key, Pass pass) {
  for (const char* part : {"update", "step"}) {
    const auto run = [&cache, key, pass](benchmark::State& state) mutable {
      const std::vector<SharedVertices>& shapes = cache.scene(key).shapes;
      std::size_t next = 0;
      for ([[maybe_unused]] const auto _ : state) {
        const std::vector<float>& shape = *shapes[next++ % shapes.size()];
        Stopwatch watch;
        pass(shape);
        state.SetIterationTime(watch.lap());
      }
    };
    add_case(case_name(part, name, key), step_count(key.faces), run);
  }
}

}  // namespace

void add_vertex_pass_cases(MeasurementCache& cache, const SceneKey& key) {
  add_pass(cache, "vertex_pass", key,
           [boxes = VertexPass()](const std::vector<float>& vertices) mutable {
             boxes.fit(vertices);
             benchmark::DoNotOptimize(boxes.low().data());
             benchmark::ClobberMemory();
           });
  add_pass(cache, "memcpy", key,
           [copy = std::vector<float>()](const std::vector<float>& vertices) mutable {
             copy.resize(vertices.size());
             std::memcpy(copy.data(), vertices.data(), vertices.size() * sizeof(float));
             benchmark::DoNotOptimize(copy.data());
             benchmark::ClobberMemory();
           });
}

}  // namespace organ_collision::bench
