#pragma once

#include <Eigen/Core>

#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// Whether a point is exactly on a face, including its edges and corners. A degenerate face is a
/// segment or a point.
bool is_on_face(const Triangle& face, const Eigen::Vector3d& point);

}  // namespace organ_collision
