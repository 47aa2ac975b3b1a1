#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace organ_collision {

/// On which side of an organ's surface a point is. The values are those of msg/ToolPlacement.msg.
enum class Side : std::uint8_t {
  /// The side was not asked for, there is no such point, the surface is not closed, or vertices
  /// that were at one place are now farther apart than tolerance::kSeam. In the node also: new
  /// triangles are not inspected yet.
  kUnknown = 0,
  kOutside = 1,   ///< the winding number of the surface about the point is zero
  kInside = 2,    ///< the winding number is not zero
  kOnSurface = 3  ///< the point is exactly on a face
};

/// Where the axis of a shaft pierces a face, with the fields of msg/Crossing.msg.
struct AxisCrossing {
  /// The number of the face.
  std::uint32_t face = 0;
  /// The indices of the face's corners among the organ's vertices, in the order of `barycentric`.
  std::array<std::uint32_t, 3> vertices = {};
  /// The barycentric coordinates of `point` in the face.
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  /// The place of the crossing on the axis, in [0, 1] from trocar to tip.
  double shaft = 0.0;
  /// [m] The place where the axis pierces the face, in the organ's frame.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// +1: the axis enters the organ here, against the face's outward normal. -1: the axis leaves the
  /// organ. The signs are reversed if the faces point inward.
  std::int8_t direction = 0;
};

/// Where a tool is at the end of a step, with the fields of msg/ToolPlacement.msg. Sides and
/// crossings are decided by exact predicates.
///
/// Where the axis meets an edge or a corner, or lies in a face, the faces that it crosses are those
/// that it would cross if it were moved by an infinitesimal vector (simulation of simplicity; see
/// doc/theory/geometry.md, Sides and crossings). So an axis that grazes the surface crosses it
/// twice or not at all, and the answer does not depend on the order of the faces. The winding
/// number at the tip minus the winding number at the trocar is always the sum of the directions.
struct AxisPlacement {
  /// The side of the tip.
  Side tip = Side::kUnknown;
  /// The side of the trocar, if the tool has a shaft.
  Side trocar = Side::kUnknown;
  /// The crossings in their order from trocar to tip, also for a surface that is not closed. Of
  /// faces that lie on each other, the faces through which the axis leaves come first.
  std::vector<AxisCrossing> crossings;
  /// Whether `length_inside` is known: the sides of tip and trocar must be.
  bool length_known = false;
  /// [m] The length of the axis within the organ; 0 if it is not known.
  double length_inside = 0.0;
};

}  // namespace organ_collision
