#pragma once

#include "closest_points.hpp"

namespace organ_collision {

/// The nearest points of a hull of three or more points and a face (possibly degenerate), by the
/// iteration of Gilbert, Johnson and Keerthi (1988). `distance_bound` [m] is as for
/// closest_points().
///
/// The iteration ends when no point can be nearer by more than 1e-12 m (or 1e-12 of the distance),
/// or when rounding prevents progress. For boxes as thin as 1e-6 m the distance may then be up to
/// 1e-7 m too large. Except for rounding, it is never too small. See doc/geometry.md, Distance
/// algorithms.
ClosestPoints gjk_closest_points(const ConvexCore& hull, const Triangle& face,
                                 double distance_bound);

}  // namespace organ_collision
