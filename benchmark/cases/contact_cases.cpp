#include "cases.hpp"
#include "registration.hpp"

namespace organ_collision::bench {
namespace {

struct PartEntry {
  const char* name;
  bool organ_moves;
  ContactMeasurement::Timed (ContactMeasurement::*run)(bool);
};

constexpr PartEntry kParts[] = {
    {"contacts", false, &ContactMeasurement::contacts},
    {"contacts_moving", true, &ContactMeasurement::contacts},
    {"step_contacts", false, &ContactMeasurement::step},
    {"step_moving", true, &ContactMeasurement::step},
};

}  // namespace

void add_contact_cases(MeasurementCache& cache, const SceneKey& key) {
  for (const PartEntry& part : kParts) {
    const auto run = [&cache, part, key](benchmark::State& state) {
      ContactMeasurement& measurement = cache.contacts(key);
      std::size_t contacts = 0;
      for ([[maybe_unused]] const auto _ : state) {
        const ContactMeasurement::Timed timed = (measurement.*part.run)(part.organ_moves);
        state.SetIterationTime(timed.seconds);
        contacts += timed.contacts;
      }
      count_errors(measurement.summary(), state);
      state.counters["contacts"] =
          benchmark::Counter(static_cast<double>(contacts), benchmark::Counter::kAvgIterations);
    };
    add_case(case_name(part.name, "ours", key), step_count(key.faces), run);
  }
}

}  // namespace organ_collision::bench
