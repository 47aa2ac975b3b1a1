#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "benchmark/scenes/scene.hpp"
#include "contact_rig.hpp"
#include "grasper_rig.hpp"
#include "rig.hpp"

namespace organ_collision::bench {

/// A mesh of so many faces, its vertices in the order of its rings or in none.
struct SceneKey {
  std::size_t faces;
  bool shuffled;

  bool operator<(const SceneKey& other) const {
    return std::pair(faces, shuffled) < std::pair(other.faces, other.shuffled);
  }
};

/// Everything that benchmarks share, made when it is first asked for and kept: scenes, and engines
/// on them.
class Lab {
 public:
  const Scene& scene(const SceneKey& key);
  /// `make`: of the engine called `name`.
  Rig& rig(const std::string& name, std::unique_ptr<Engine> (*make)(), const SceneKey& key,
           bool rigid);
  ContactRig& contact_rig(const SceneKey& key);
  GrasperRig& grasper_rig();

  /// Faces that the package's own pickers missed or found wrongly, in all scenes so far.
  std::size_t own_errors() const { return own_errors_; }

 private:
  void tell(const std::string& name, const SceneKey& key, const Findings& findings);

  std::map<SceneKey, std::unique_ptr<Scene>> scenes_;
  std::map<std::tuple<std::string, SceneKey, bool>, std::unique_ptr<Rig>> rigs_;
  std::map<SceneKey, std::unique_ptr<ContactRig>> contact_rigs_;
  std::unique_ptr<GrasperRig> grasper_rig_;
  std::size_t own_errors_ = 0;
};

}  // namespace organ_collision::bench
