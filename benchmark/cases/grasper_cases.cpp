#include "cases.hpp"
#include "registration.hpp"

namespace organ_collision::bench {
namespace {

struct PartEntry {
  const char* name;
  double (GrasperMeasurement::*run)();
  const CheckSummary& (GrasperMeasurement::*summary)() const;
};

constexpr PartEntry kParts[] = {
    {"grasper_static/ours/1224", &GrasperMeasurement::static_query, &GrasperMeasurement::summary},
    {"grasper_swept/ours/1224", &GrasperMeasurement::swept_query, &GrasperMeasurement::summary},
    {"grasper_static/fcl/1224", &GrasperMeasurement::fcl_static_query,
     &GrasperMeasurement::fcl_summary},
};

}  // namespace

void add_grasper_cases(MeasurementCache& cache) {
  for (const PartEntry& part : kParts) {
    add_case(part.name, step_count(1224), [&cache, part](benchmark::State& state) {
      GrasperMeasurement& measurement = cache.grasper();
      for ([[maybe_unused]] const auto _ : state) {
        state.SetIterationTime((measurement.*part.run)());
      }
      count_errors((measurement.*part.summary)(), state);
    });
  }
}

}  // namespace organ_collision::bench
