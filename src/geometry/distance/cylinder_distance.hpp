#pragma once

#include "closest_points.hpp"

namespace organ_collision {

/// The nearest points of a flat-ended cylinder and a face. A face's inside is nearest to the
/// cylinder's foremost point along the face's normal; on an edge, the distance is a convex function
/// of the place, whose derivative is brought to zero.
ClosestPoints cylinder_closest_points(const ConvexCore& cylinder, const Triangle& face);

}  // namespace organ_collision
