#pragma once

#include <vector>

#include "benchmark/scenes/scene.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "picking/pickers/picker.hpp"
#include "timing.hpp"

namespace organ_collision::bench {

/// Times contacts with full geometry on the steps of a scene: the refinement alone, and the
/// package's whole query.
class ContactMeasurement {
 public:
  /// Checks the faces of the contacts against brute force before anything is timed. `scene` must
  /// outlive this object.
  explicit ContactMeasurement(const Scene& scene);

  const CheckSummary& summary() const { return summary_; }

  struct Timed {
    double seconds;
    std::size_t contacts;  ///< of the static and the swept query together
  };
  /// Times only the refinement of the next step's candidates. In the swept query, the organ moves
  /// to its new shape if `organ_moves`; otherwise it rests in the new shape.
  Timed contacts(bool organ_moves);
  /// Times the whole next step: update, static query and swept query.
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
  CheckSummary summary_;
  std::size_t next_ = 0;
};

}  // namespace organ_collision::bench
