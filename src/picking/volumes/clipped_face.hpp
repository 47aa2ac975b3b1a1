#pragma once

#include <Eigen/Core>
#include <vector>

#include "organ_collision/geometry/triangle.hpp"
#include "viewing_volume.hpp"

namespace organ_collision {

/// The corners of a convex polygon, in their order along its border. One or two corners are a point
/// or a segment. None: it is empty.
using ConvexPolygon = std::vector<Eigen::Vector3d>;

/// The part of a face in a viewing volume, in double precision. The face and its part are in the
/// volume's shifted coordinates [m]. A face that only touches the volume has a part, too.
ConvexPolygon clipped(const Triangle& face, const ViewingVolume& volume);

}  // namespace organ_collision
