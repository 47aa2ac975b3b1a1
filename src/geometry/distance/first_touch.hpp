#pragma once

#include <optional>

#include "closest_points.hpp"
#include "geometry/organ/organ_motion.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "work_budget.hpp"

namespace organ_collision {

/// When a part's core first comes within the radius of a face, and where.
struct FirstTouch {
  double time;  ///< time of impact, in [0, 1] of the leg
  ClosestPoints closest;
  /// False if the search stopped early, because the work budget ran out or it made too many
  /// advances. Core and face do not touch before `time`. Whether they touch later is unknown.
  bool is_resolved = true;
};

/// The first time of the leg, up to `until`, at which distance(face, core) <= radius [m]; none if
/// the core stays farther away until then. The distance is resolved to tolerance::kTouch plus
/// kRounding of the largest coordinate. This one routine serves fixed and moving trocars, links
/// that turn, and faces at rest and in motion.
///
/// No touching face is missed if the budget runs out before the search has decided: the result is
/// then a touch with `is_resolved` false.
///
/// Method: conservative advancement with a turning plane. See doc/geometry.md, First touch.
std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      WorkBudget& budget, double until = 1.0);

/// The same with an unlimited budget.
std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      double until = 1.0);

}  // namespace organ_collision
