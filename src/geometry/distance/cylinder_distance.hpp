#pragma once

#include "closest_points.hpp"

namespace organ_collision {

/// The nearest points of a flat-ended cylinder and a face (possibly degenerate). The face's nearest
/// point is the projection of the cylinder's support point, or it lies on an edge. On an edge the
/// distance is a convex function of the place, and Newton's method finds its minimum. See
/// doc/geometry.md, Distance algorithms.
ClosestPoints cylinder_closest_points(const ConvexCore& cylinder, const Triangle& face);

}  // namespace organ_collision
