#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/tool_surface.hpp"

namespace organ_collision {

/// A part of a link, in the link's frame: all points within `radius` of the core. If the part has a
/// surface, it is all points within `radius` of the surface.
struct LinkPart {
  ConvexCore core;                             ///< the convex core; unused if there is a surface
  std::shared_ptr<const ToolSurface> surface;  ///< the triangle mesh; null if the part is convex
  double radius;                               ///< [m] radius around core or surface, > 0
  OrientedBox bounds;                          ///< box around core or surface, without the radius

  // The shapes of URDF, at a pose in the link's frame. Sizes are in metres and positive. Shapes
  // with flat faces get the radius tolerance::kConvexMargin.

  /// A ball.
  static LinkPart sphere(const Eigen::Vector3d& center, double radius);
  /// A cylinder around the z axis of the shape, centred at its origin, with flat ends.
  static LinkPart cylinder(const Eigen::Isometry3d& T_link_shape, double radius, double length);
  /// A box centred at the shape's origin, with the edge lengths `size` along x, y and z.
  static LinkPart box(const Eigen::Isometry3d& T_link_shape, const Eigen::Vector3d& size);
  /// A mesh whose vertices are in the link's frame.
  static LinkPart mesh(ToolSurface surface);

  /// [m] The radius of a ball. 0 for the other shapes: their radius is only the convex margin, and
  /// the clearance is measured without it.
  double ball_radius() const { return !surface && core.count == 1 ? radius : 0.0; }

  /// The least and the greatest direction · point of core or surface, without the radius.
  ProjectionInterval project_onto(const Eigen::Vector3d& direction) const;
};

/// A link of a tool: several parts that move rigidly together.
struct Link {
  std::string name;             ///< the name, as in the robot's URDF
  std::vector<LinkPart> parts;  ///< the link touches what one of its parts touches
};

}  // namespace organ_collision
