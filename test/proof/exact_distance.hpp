#pragma once

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

/// Answers by exact arithmetic on the given doubles, to measure the library against.
namespace organ_collision::oracle {

/// Whether the exact squared distance of two triangles is at most radius². Each triangle may be
/// degenerate to a segment or a point.
bool within(const Triangle& a, const Triangle& b, double radius);

/// The exact distance of two triangles [m], rounded to a double.
double distance(const Triangle& a, const Triangle& b);

/// The axis of a tool at rest, as a triangle that is degenerate to a segment.
inline Triangle core(const ShaftAxis& axis) { return {axis.trocar, axis.tip, axis.tip}; }

/// The triangle that an axis sweeps while its trocar rests.
inline Triangle core(const ShaftMotion& motion) {
  return {motion.start.trocar, motion.start.tip, motion.end.tip};
}

}  // namespace organ_collision::oracle
