#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// The interval that a shape covers along a direction: the least and the greatest value of
/// direction · point over its points. In metres if the direction is a unit vector.
struct ProjectionInterval {
  double low;   ///< the least value
  double high;  ///< the greatest value
};

/// A box in any orientation [m].
struct OrientedBox {
  Eigen::Vector3d center;     ///< the middle of the box
  Eigen::Matrix3d axes;       ///< directions of the edges: orthonormal columns, right-handed
  Eigen::Vector3d half_size;  ///< half of the edge lengths along `axes`; not negative

  /// The greatest direction · point of the box. `direction` need not be a unit vector.
  double support_value(const Eigen::Vector3d& direction) const {
    return direction.dot(center) + (direction.transpose() * axes).cwiseAbs() * half_size;
  }
};

/// A convex part of a tool without its radius: the hull of up to eight points or of two discs [m].
/// The part of the tool is all points within the radius of the core. One point is the core of a
/// ball, two points of a shaft, three of a triangle of a mesh, eight of a box, and two discs of a
/// flat-ended cylinder.
struct ConvexCore {
  /// The first `count` elements are the core's points. The others are unspecified.
  std::array<Eigen::Vector3d, 8> points;
  /// The number of points of the core.
  std::size_t count = 0;
  /// For a flat-ended cylinder, whose two points are the centres of its ends: two vectors from a
  /// centre to the rim, at right angles to each other and to the axis [m]. Zero for other cores.
  Eigen::Matrix<double, 3, 2> rim = Eigen::Matrix<double, 3, 2>::Zero();

  ConvexCore() = default;
  /// The core of a shaft: its axis.
  // NOLINTNEXTLINE(google-explicit-constructor)
  ConvexCore(const ShaftAxis& axis) : points{axis.trocar, axis.tip}, count(2) {}
  /// The core of a triangle of a mesh.
  explicit ConvexCore(const Triangle& triangle)
      : points{triangle[0], triangle[1], triangle[2]}, count(3) {}

  /// The point of the core that is farthest along `direction`, which need not be a unit vector.
  Eigen::Vector3d support(const Eigen::Vector3d& direction) const;
  /// The greatest value of direction · point over the core's points.
  double support_value(const Eigen::Vector3d& direction) const;
  /// Whether this is the core of a ball or a shaft.
  bool is_axis() const { return count <= 2 && !is_cylinder(); }
  /// Whether this is the core of a triangle of a mesh.
  bool is_triangle() const { return count == 3; }
  /// Whether this is the core of a flat-ended cylinder.
  bool is_cylinder() const { return rim(0, 0) != 0.0 || rim(1, 0) != 0.0 || rim(2, 0) != 0.0; }
  /// The segment from the first point to the last. It is the whole core of a ball or a shaft.
  ShaftAxis axis() const { return {points[0], points[count - 1]}; }
  /// The triangle of the first three points. For a triangle of a mesh, this is the whole core.
  Triangle triangle() const { return {points[0], points[1], points[2]}; }
};

/// The core, moved by a rigid transform.
ConvexCore operator*(const Eigen::Isometry3d& T_to_from, const ConvexCore& core);

}  // namespace organ_collision
