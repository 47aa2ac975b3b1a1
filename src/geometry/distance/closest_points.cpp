#include "closest_points.hpp"

#include "axis_distance.hpp"
#include "cylinder_distance.hpp"
#include "gjk.hpp"

namespace organ_collision {

ClosestPoints closest_points(const ConvexCore& core, const Triangle& face, double distance_bound) {
  if (core.is_axis()) return axis_closest_points(core.axis(), face);
  if (core.is_cylinder()) return cylinder_closest_points(core, face);
  return gjk_closest_points(core, face, distance_bound);
}

}  // namespace organ_collision
