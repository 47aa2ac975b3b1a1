#pragma once

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"

namespace organ_collision::oracle {

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
