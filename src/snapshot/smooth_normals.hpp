#pragma once

#include "shapes.hpp"

namespace organ_collision {

/// The unit normal of each corner, for the light. Faces that meet at a point with a small angle
/// between them share their normal there, so a curved surface looks smooth and an edge stays sharp.
/// A degenerate triangle has zero normals.
std::vector<Eigen::Vector3d> smooth_normals(const TrianglePoints& triangles);

}  // namespace organ_collision
