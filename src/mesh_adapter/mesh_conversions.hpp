#pragma once

#include <pcl_msgs/PolygonMesh.h>
#include <shape_msgs/Mesh.h>

#include "received_surface.hpp"

namespace organ_collision {

// Conversions from messages with a mesh to surfaces. Vertices keep their order and are rounded to
// 32-bit floats. The content of `surface` is replaced, and its memory is reused.

/// The surface has no frame and no stamp, because the message has none.
void convert(const shape_msgs::Mesh& mesh, ReceivedSurface& surface);

/// A polygon of n corners is cut into a fan around its first corner and becomes n - 2 faces. If the
/// mesh's own header has no frame or no stamp, the one in the cloud's header is used. Throws
/// MessageError.
void convert(const pcl_msgs::PolygonMesh& mesh, ReceivedSurface& surface);

}  // namespace organ_collision
