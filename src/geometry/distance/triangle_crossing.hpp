#pragma once

#include <optional>

#include "closest_points.hpp"

namespace organ_collision {

/// Decides quickly about most pairs of triangles, without an iteration. If the triangles cross,
/// these are a common point, in the middle of their line of intersection, and a distance of at most
/// tolerance::kTie. If each triangle meets the other one's plane and they are farther apart than
/// `distance_bound` [m], the result is as that of closest_points() in this case: a lower bound of
/// the distance that is greater than `distance_bound`, and unspecified points. None if neither is
/// certain, for example because the plane of a triangle separates them, which callers test first.
///
/// Method: each triangle cuts the other one's plane in a segment of the line in which the two
/// planes meet. If the segments overlap, the triangles cross. If not, the two edges that bound the
/// gap lie in parallel planes between which there is nothing of either triangle. Source: Möller,
/// "A fast triangle-triangle intersection test", 1997. See doc/geometry.md, Distance algorithms.
std::optional<ClosestPoints> triangle_crossing(const Triangle& core, const Triangle& face,
                                               double distance_bound);

}  // namespace organ_collision
