#pragma once

#include <pcl_msgs/PolygonMesh.h>
#include <shape_msgs/Mesh.h>

#include "surface.hpp"

namespace organ_collision {

// Messages that are meshes, as surfaces. Vertices keep their order and are rounded to 32-bit
// floats; what `surface` held is replaced, its memory used again.

/// Names neither frame nor stamp.
void convert(const shape_msgs::Mesh& mesh, Surface& surface);

/// A polygon of n corners is cut into a fan around its first one and counts as n - 2 faces. Where
/// the mesh's own header names no frame, or no stamp, the cloud's does. Throws MessageError.
void convert(const pcl_msgs::PolygonMesh& mesh, Surface& surface);

}  // namespace organ_collision
