#pragma once

#include <Eigen/Core>
#include <vector>

namespace organ_collision {

/// Corners of the convex hull of points in the plane, counterclockwise, without those inside an
/// edge. One corner if all points coincide, two if they lie on a line.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

}  // namespace organ_collision
