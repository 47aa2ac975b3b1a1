#pragma once

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

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

/// The distance of two triangles [m] in doubles. It is a thousand times faster than exact
/// arithmetic, for searches that need many distances. Each triangle may be degenerate to a segment
/// or a point. Each candidate is the distance of two real points, so rounding cannot make the
/// result smaller than the true distance by more than rounding itself.
double rounded_distance(const Triangle& a, const Triangle& b);

/// Distance between a link's core and a face [m]. For the core of a ball, a triangle or a box it is
/// exact, computed from exact distances between triangles. For a cylinder it is accurate to about
/// 1e-11 m, found by golden section search over the points of the face.
double distance(const ConvexCore& core, const Triangle& face);

/// Whether the distance between a core and a face is at most `radius` [m]. Exact, or for a cylinder
/// to about 1e-11 m.
bool within(const ConvexCore& core, const Triangle& face, double radius);

/// The distance between a core and a face [m] in doubles, for searches that need many distances.
/// For a cylinder it is at most about 1e-9 m too large.
double rounded_distance(const ConvexCore& core, const Triangle& face);

/// Distance between a link's core and a point [m], 0 inside the core.
double distance(const ConvexCore& core, const Eigen::Vector3d& point);

}  // namespace organ_collision::oracle
