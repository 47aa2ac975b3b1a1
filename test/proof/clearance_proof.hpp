#pragma once

#include "clearance_trials.hpp"
#include "exactness_proof.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision::oracle {

/// Asks the library and the oracles how far a tool is from an organ. Prints every trial in which
/// the answers differ by more than 1e-9 m at the end of the step, or 1e-6 m during it. The tally
/// counts it as "wrong".
class ClearanceComparison {
 public:
  explicit ClearanceComparison(PickerKind picker) : query_(picker) {}

  Tally compare(const ClearanceTrial& trial);

 private:
  CollisionQuery query_;
  CollisionResult result_;
};

}  // namespace organ_collision::oracle
