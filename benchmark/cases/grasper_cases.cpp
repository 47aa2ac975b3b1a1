#include "grasper_cases.hpp"

#include "benchmark/scenes/scene.hpp"
#include "cases.hpp"
#include "query/make_request.hpp"

namespace organ_collision::bench {
namespace {

constexpr std::size_t kFaces = 1224;

}  // namespace

GrasperMeasurement::GrasperMeasurement()
    : surface_(make_organ(kFaces)),
      organ_(surface_.vertices, surface_.triangles),
      motions_(grasper_motions(surface_, step_count(kFaces))),
      fcl_(surface_, motions_.radius, motions_.links) {}

CollisionRequest GrasperMeasurement::request(const ToolPath& path, QueryMode mode) const {
  return make_request({&organ_}, {motions_.radius, &motions_.links}, {mode}, path);
}

double GrasperMeasurement::query(QueryMode mode) {
  const CollisionRequest next = request(motions_.paths[next_++ % motions_.paths.size()], mode);
  Stopwatch watch;
  query_.evaluate(next, result_);
  return watch.lap();
}

double GrasperMeasurement::fcl_static_query() {
  const ToolPath& path = motions_.paths[next_++ % motions_.paths.size()];
  Stopwatch watch;
  fcl_.query(path.back(), faces_);
  return watch.lap();
}

namespace {

struct PartEntry {
  const char* name;
  double (GrasperMeasurement::*run)();
};

constexpr PartEntry kParts[] = {
    {"grasper_static/ours/1224", &GrasperMeasurement::static_query},
    {"grasper_swept/ours/1224", &GrasperMeasurement::swept_query},
    {"grasper_static/fcl/1224", &GrasperMeasurement::fcl_static_query},
};

}  // namespace

void add_grasper_cases(MeasurementCache& cache) {
  for (const PartEntry& part : kParts) {
    add_case(part.name, step_count(1224), [&cache, part](benchmark::State& state) {
      GrasperMeasurement& measurement = cache.grasper();
      for ([[maybe_unused]] const auto _ : state) {
        state.SetIterationTime((measurement.*part.run)());
      }
    });
  }
}

}  // namespace organ_collision::bench
