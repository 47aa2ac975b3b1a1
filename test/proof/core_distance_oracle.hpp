#pragma once

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"

namespace organ_collision::oracle {

/// [m] Distance of a link's core and a face: of a ball's, a triangle's or a box's core exactly,
/// from exact distances of triangles; of a cylinder's to 1e-11 m or so, by golden sections over the
/// face of the distance from a point.
double distance(const ConvexCore& core, const Triangle& face);

/// [m] Of a point; 0 in the core. Of a triangle's core: from the triangle.
double distance(const ConvexCore& core, const Eigen::Vector3d& point);

}  // namespace organ_collision::oracle
