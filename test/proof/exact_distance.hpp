#pragma once

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

/// Answers by exact arithmetic on the very doubles given: what the library is measured against.
namespace organ_collision::oracle {

/// Whether two triangles come within `radius` of each other: squaredDistance <= radius², exactly.
/// Either may be degenerate to a segment or a point.
bool within(const Triangle& a, const Triangle& b, double radius);

/// [m] Distance of two triangles: the exact one, rounded to a double.
double distance(const Triangle& a, const Triangle& b);

/// What the axis of a tool at rest is: a triangle degenerate to a segment.
inline Triangle core(const ShaftAxis& axis) { return {axis.trocar, axis.tip, axis.tip}; }

/// What an axis sweeps while its trocar rests.
inline Triangle core(const ShaftMotion& motion) {
  return {motion.start.trocar, motion.start.tip, motion.end.tip};
}

}  // namespace organ_collision::oracle
