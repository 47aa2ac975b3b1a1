#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "benchmark/scenes/scene.hpp"
#include "contact_cases.hpp"
#include "engine_cases.hpp"
#include "grasper_cases.hpp"
#include "where_cases.hpp"

namespace organ_collision::bench {

/// Identifies a scene.
struct SceneKey {
  std::size_t faces;
  bool shuffled;  ///< whether vertices and faces are in random order

  bool operator<(const SceneKey& other) const {
    return std::pair(faces, shuffled) < std::pair(other.faces, other.shuffled);
  }
};

/// The scenes and measurements that benchmarks share. Each is made when it is first asked for, so
/// that a filtered run makes only those that it needs. A measurement is then checked, and the
/// errors are reported on stderr.
class MeasurementCache {
 public:
  const Scene& scene(const SceneKey& key);
  /// `make` creates the engine called `engine`.
  EngineMeasurement& engine(const std::string& engine, std::unique_ptr<Engine> (*make)(),
                            const SceneKey& key, bool rigid);
  ContactMeasurement& contacts(const SceneKey& key);
  GrasperMeasurement& grasper();
  /// `make` creates the locator called `locator`.
  WhereMeasurement& where(const std::string& locator, std::unique_ptr<Locator> (*make)(),
                          const SceneKey& key);

  /// Number of faces that the package itself has missed or found wrongly so far.
  std::size_t own_errors() const { return own_errors_; }

 private:
  void report_check(const std::string& name, const SceneKey& key, const CheckSummary& summary);

  std::map<SceneKey, std::unique_ptr<Scene>> scenes_;
  std::map<std::tuple<std::string, SceneKey, bool>, std::unique_ptr<EngineMeasurement>> engines_;
  std::map<SceneKey, std::unique_ptr<ContactMeasurement>> contacts_;
  std::unique_ptr<GrasperMeasurement> grasper_;
  std::map<std::pair<std::string, SceneKey>, std::unique_ptr<WhereMeasurement>> where_;
  std::size_t own_errors_ = 0;
};

}  // namespace organ_collision::bench
