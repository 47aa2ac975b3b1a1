#pragma once

#include <cstdint>
#include <vector>

#include "approach_finder.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "step.hpp"

namespace organ_collision {

/// Finds the faces within a margin of a tool that it does not touch during a step. Keeps its memory
/// between steps.
class NearFinder {
 public:
  /// Sets what `result` tells about near faces. The contacts in it are those of the step.
  void find(const Step& step, const CollisionRequest& request, CollisionResult& result,
            WorkBudget budget = WorkBudget::for_approaches());

 private:
  class Collector;

  ApproachFinder approaches_;
  std::vector<PartApproach> nearest_;  ///< one for each near face
  /// What is known of each face: kNothing, kTouched, kUnresolved, or its place in nearest_.
  std::vector<std::uint32_t> places_;
};

}  // namespace organ_collision
