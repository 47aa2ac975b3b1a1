#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <vector>

namespace organ_collision {

/// The corners of a triangle, in order [m]. Its outward side is given by the right-hand rule.
using Triangle = std::array<Eigen::Vector3d, 3>;

/// A convex polygon: its corners in their order along its border [m]. One corner is a point, two
/// are a segment, and none is the empty polygon.
using Region = std::vector<Eigen::Vector3d>;

/// [m] The point with the given barycentric coordinates: one for each corner, with the sum 1.
inline Eigen::Vector3d point_at(const Triangle& triangle, const Eigen::Vector3d& barycentric) {
  return barycentric[0] * triangle[0] + barycentric[1] * triangle[1] + barycentric[2] * triangle[2];
}

/// The triangle in coordinates that are shifted so that `origin` is zero.
inline Triangle shifted(const Triangle& triangle, const Eigen::Vector3d& origin) {
  return {triangle[0] - origin, triangle[1] - origin, triangle[2] - origin};
}

/// A vector along the outward normal whose length is twice the area [m^2]. Zero if the triangle is
/// degenerate.
inline Eigen::Vector3d twice_area(const Triangle& triangle) {
  return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

/// [m] The largest absolute coordinate of the corners.
inline double largest_coordinate(const Triangle& triangle) {
  return std::max({triangle[0].cwiseAbs().maxCoeff(), triangle[1].cwiseAbs().maxCoeff(),
                   triangle[2].cwiseAbs().maxCoeff()});
}

}  // namespace organ_collision
