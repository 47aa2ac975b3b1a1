#pragma once

#include <optional>

#include "closest_points.hpp"
#include "geometry/organ/organ_motion.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tool/tool_surface.hpp"
#include "work_budget.hpp"

namespace organ_collision {

/// Where and when a part of a tool comes nearest to a face.
struct ClosestApproach {
  double time;  ///< the time, in [0, 1] of the leg
  ClosestPoints closest;
};

/// The closest approach of a core and a face during a leg: a global minimum of their distance, to
/// within tolerance::kApproach. If neither moves, the result is their closest points, without that
/// tolerance. Returns nothing if the distance stays above `distance_bound` [m]. It may also return
/// nothing if the distance falls below that bound by less than the tolerance.
///
/// If `budget` runs out before the search is done, the budget counts a cut (WorkBudget::cuts()),
/// and the result is an upper bound, or nothing.
///
/// Method: the leg is halved until a turning plane, or the speed of the motion, shows for each
/// interval that the distance cannot be smaller in it. See doc/theory/geometry.md, Closest
/// approach.
std::optional<ClosestApproach> closest_approach(const CoreMotion& core, const FaceMotion& face,
                                                double distance_bound, WorkBudget& budget);

/// The closest approach of the surface of a link and a face. The tree of boxes of the surface leads
/// to its nearest triangles.
std::optional<ClosestApproach> closest_approach(const ToolSurface& surface,
                                                const RigidMotion& motion, const FaceMotion& face,
                                                double distance_bound, WorkBudget& budget);

}  // namespace organ_collision
