#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// A convex part of a tool without its radius: the hull of up to eight points or of two discs [m].
/// The part is all points within the radius of the core. One point makes a ball, two a shaft, three
/// a triangle of a mesh, eight a box, two discs a flat-ended cylinder.
struct ConvexCore {
  /// The first `count` of them are the core's points. The others are unspecified.
  std::array<Eigen::Vector3d, 8> points;
  /// The number of points.
  std::size_t count = 0;
  /// For a flat-ended cylinder, whose two points are the centres of its ends: two vectors from a
  /// centre to the rim, at right angles to each other and to the axis [m]. Zero for other cores.
  Eigen::Matrix<double, 3, 2> rim = Eigen::Matrix<double, 3, 2>::Zero();

  ConvexCore() = default;
  /// A shaft's axis is a core.
  // NOLINTNEXTLINE(google-explicit-constructor)
  ConvexCore(const ShaftAxis& axis) : points{axis.trocar, axis.tip}, count(2) {}
  /// The core that is a triangle.
  explicit ConvexCore(const Triangle& triangle)
      : points{triangle[0], triangle[1], triangle[2]}, count(3) {}

  /// The point of the core farthest along `direction`, which need not be unit.
  Eigen::Vector3d support(const Eigen::Vector3d& direction) const;
  /// The greatest direction · point of the core's points.
  double support_value(const Eigen::Vector3d& direction) const;
  /// A ball or a shaft.
  bool is_axis() const { return count <= 2 && !is_cylinder(); }
  /// A triangle of a mesh.
  bool is_triangle() const { return count == 3; }
  /// A flat-ended cylinder.
  bool is_cylinder() const { return rim(0, 0) != 0.0 || rim(1, 0) != 0.0 || rim(2, 0) != 0.0; }
  /// The segment from the first point to the last one. For a ball or a shaft, this is the whole
  /// core.
  ShaftAxis axis() const { return {points[0], points[count - 1]}; }
  /// The triangle of the first three points. For a triangle core, this is the whole core.
  Triangle triangle() const { return {points[0], points[1], points[2]}; }
};

/// The core moved rigidly.
ConvexCore operator*(const Eigen::Isometry3d& T_to_from, const ConvexCore& core);

}  // namespace organ_collision
