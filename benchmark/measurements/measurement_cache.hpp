#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "benchmark/scenes/scene.hpp"
#include "contact_measurement.hpp"
#include "engine_measurement.hpp"
#include "grasper_measurement.hpp"

namespace organ_collision::bench {

/// Identifies a scene.
struct SceneKey {
  std::size_t faces;
  bool shuffled;  ///< whether vertices and faces are in random order

  bool operator<(const SceneKey& other) const {
    return std::pair(faces, shuffled) < std::pair(other.faces, other.shuffled);
  }
};

/// Everything that benchmarks share: scenes and the measurements on them. Each is made, checked and
/// its errors reported on stderr when it is first asked for, so a filtered run makes only what it
/// needs.
class MeasurementCache {
 public:
  const Scene& scene(const SceneKey& key);
  /// `make` creates the engine called `engine`.
  EngineMeasurement& engine(const std::string& engine, std::unique_ptr<Engine> (*make)(),
                            const SceneKey& key, bool rigid);
  ContactMeasurement& contacts(const SceneKey& key);
  GrasperMeasurement& grasper();

  /// Number of faces that the package's own pickers missed or found wrongly so far.
  std::size_t own_errors() const { return own_errors_; }

 private:
  void report_check(const std::string& name, const SceneKey& key, const CheckSummary& summary);

  std::map<SceneKey, std::unique_ptr<Scene>> scenes_;
  std::map<std::tuple<std::string, SceneKey, bool>, std::unique_ptr<EngineMeasurement>> engines_;
  std::map<SceneKey, std::unique_ptr<ContactMeasurement>> contacts_;
  std::unique_ptr<GrasperMeasurement> grasper_;
  std::size_t own_errors_ = 0;
};

}  // namespace organ_collision::bench
