#pragma once

#include <optional>

#include "closest_points.hpp"
#include "geometry/organ/organ_motion.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "work_budget.hpp"

namespace organ_collision {

/// A common point of two triangles that cross each other: the middle of the segment in which they
/// intersect. Its distance is at most tolerance::kTie. Nothing if the triangles do not cross, or if
/// that is not certain. The point needs no iteration and depends only on the triangles.
///
/// Method: each triangle cuts the other one's plane in a segment of the line in which the two
/// planes meet. If the segments overlap, the triangles cross. Source: Möller, "A fast
/// triangle-triangle intersection test", 1997. See doc/theory/geometry.md, Distance algorithms.
std::optional<ClosestPoints> triangle_crossing(const Triangle& core, const Triangle& face);

/// When a part's core first comes within the radius of a face, and where.
struct FirstTouch {
  double time;  ///< the time of impact, in [0, 1] of the leg
  ClosestPoints closest;
  /// False if the search stopped early, because the work budget ran out or it made too many
  /// advances. Core and face do not touch before `time`. Whether they touch later is unknown.
  bool is_resolved = true;
};

/// The first time of the leg, up to `until`, at which the distance of face and core is at most
/// `radius` [m]. Nothing if the core stays farther away until then. The distance found may exceed
/// the radius by tolerance::kTouch plus kRounding times the largest coordinate. This one routine
/// serves fixed and moving trocars, links that turn, and faces at rest and in motion.
///
/// If the budget runs out before the search has decided, the result is a touch with `is_resolved`
/// false. So no face that touches is missed.
///
/// Method: conservative advancement with a turning plane. See doc/theory/geometry.md, First touch.
std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      WorkBudget& budget, double until = 1.0);

/// The first touch, searched with an unlimited budget.
std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      double until = 1.0);

}  // namespace organ_collision
