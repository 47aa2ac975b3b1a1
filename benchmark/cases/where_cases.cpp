#include <algorithm>

#include "cases.hpp"
#include "registration.hpp"

namespace organ_collision::bench {
namespace {

struct LocatorEntry {
  const char* name;
  std::unique_ptr<Locator> (*make)();
  double face_seconds;  ///< [s] rough time of a step, divided by the number of faces
};

constexpr LocatorEntry kLocators[] = {{"ours", make_our_locator, 1e-9},
                                      {"ours_unlimited", make_our_unlimited_locator, 1e-9},
                                      {"ours_near", make_our_near_locator, 1e-9},
                                      {"fcl", make_fcl_locator, 1e-6},
                                      {"embree", make_embree_locator, 5e-8},
                                      {"cgal", make_cgal_locator, 2e-6}};

/// A round through the scene's steps, or fewer steps, but not fewer than four: they differ in how
/// far the tool is.
std::size_t steps_per_repetition(std::size_t faces, double face_seconds) {
  constexpr double kSeconds = 0.05;
  const double affordable = kSeconds / (face_seconds * static_cast<double>(faces));
  return static_cast<std::size_t>(
      std::clamp(affordable, 4.0, static_cast<double>(step_count(faces))));
}

}  // namespace

void add_where_cases(MeasurementCache& cache, const SceneKey& key) {
  for (const LocatorEntry& entry : kLocators) {
    const auto run = [&cache, entry, key](benchmark::State& state) {
      WhereMeasurement& measurement = cache.where(entry.name, entry.make, key);
      for ([[maybe_unused]] const auto _ : state) state.SetIterationTime(measurement.step());
      count_errors(measurement.summary(), state);
    };
    add_case(case_name("where", entry.name, key),
             steps_per_repetition(key.faces, entry.face_seconds), run);
  }
}

}  // namespace organ_collision::bench
