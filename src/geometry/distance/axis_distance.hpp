#pragma once

#include "closest_points.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// The nearest points of an axis (possibly a single point) and a face (possibly degenerate to a
/// segment or a point), in closed form. If several pairs are tied within tolerance::kTie, the
/// points are those nearest the tip. The distance is always the least one. See doc/geometry.md,
/// Ties and piercing.
ClosestPoints axis_closest_points(const ShaftAxis& axis, const Triangle& face);

}  // namespace organ_collision
