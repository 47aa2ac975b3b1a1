#pragma once

#include <vector>

#include "benchmark/scenes/scene.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "picking/pickers/picker.hpp"
#include "rig.hpp"

namespace organ_collision::bench {

/// What contacts with full geometry cost: the package's whole query on a scene, step after step.
class ContactRig {
 public:
  /// Checks the faces of contacts against brute force before anything is timed.
  explicit ContactRig(const Scene& scene);

  const Findings& findings() const { return findings_; }

  struct Timed {
    double seconds;
    std::size_t contacts;  ///< of the static and the swept query together
  };
  /// Refinement alone of the candidates of the next step, the organ at rest in its new shape or
  /// moving to it.
  Timed contacts(bool organ_moves);
  /// The whole next step: update, static and swept query, refined.
  Timed step(bool organ_moves);

 private:
  void check(std::size_t steps, bool organ_moves);
  void move_organ(const SceneStep& step);
  CollisionRequest request(const SceneStep& step, QueryMode mode, bool organ_moves) const;

  const Scene& scene_;
  TriangleMesh organ_, before_;
  CollisionQuery query_;
  std::unique_ptr<Picker> picker_;
  std::vector<Candidate> candidates_;
  CollisionResult result_;
  Findings findings_;
  std::size_t next_ = 0;
};

}  // namespace organ_collision::bench
