#pragma once

#include <optional>
#include <vector>

#include "approach_finder.hpp"
#include "organ_collision/query/clearance.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/query/contact.hpp"
#include "step.hpp"

namespace organ_collision {

/// Finds how far a tool is from an organ at the end of a step, and how near it came during the
/// step. Keeps its memory between steps.
class ClearanceFinder {
 public:
  /// The clearance that the request asks for. `contacts`: those of the step.
  ToolClearance find(const Step& step, const CollisionRequest& request,
                     const std::vector<FaceContact>& contacts,
                     WorkBudget budget = WorkBudget::for_approaches());

 private:
  std::optional<PartApproach> nearest(const Step& step, double distance_bound);
  void set_least(const Step& step, const CollisionRequest& request,
                 const std::vector<FaceContact>& contacts, ToolClearance& clearance);

  ApproachFinder approaches_;
  WorkBudget budget_;  ///< of the present step
};

}  // namespace organ_collision
