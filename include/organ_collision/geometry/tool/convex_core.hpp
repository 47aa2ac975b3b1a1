#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// What a convex part of a tool is without its radius: the hull of a few points, or of two discs
/// [m].
struct ConvexCore {
  std::array<Eigen::Vector3d, 8> points;
  std::size_t count = 0;
  /// Of a flat-ended cylinder, whose two points are the ends' centres: from a centre to the rim, in
  /// two directions at right angles to each other and to the axis [m]. Else zero.
  Eigen::Matrix<double, 3, 2> rim = Eigen::Matrix<double, 3, 2>::Zero();

  ConvexCore() = default;
  // An axis is a core. NOLINTNEXTLINE(google-explicit-constructor)
  ConvexCore(const ShaftAxis& axis) : points{axis.trocar, axis.tip}, count(2) {}

  /// The core's point farthest along `direction`, which need not be unit.
  Eigen::Vector3d support(const Eigen::Vector3d& direction) const;
  /// How far the core reaches along `direction`: direction · support(direction).
  double height(const Eigen::Vector3d& direction) const;
  /// Whether its nearest points have a place on a straight axis: a ball or a shaft.
  bool is_axis() const { return count <= 2 && !is_cylinder(); }
  bool is_cylinder() const { return rim(0, 0) != 0.0 || rim(1, 0) != 0.0 || rim(2, 0) != 0.0; }
  ShaftAxis axis() const { return {points[0], points[count - 1]}; }
};

/// The core moved rigidly.
ConvexCore operator*(const Eigen::Isometry3d& T_to_from, const ConvexCore& core);

}  // namespace organ_collision
