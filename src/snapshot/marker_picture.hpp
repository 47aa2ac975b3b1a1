#pragma once

#include <visualization_msgs/Marker.h>

#include <Eigen/Geometry>
#include <vector>

#include "renderer.hpp"

namespace organ_collision {

/// Adds the triangles of a marker, as RViz shows it: a list of triangles with a colour for each
/// corner has no light, and lines face the viewer. Unlike in RViz, surfaces are smooth. Draws the
/// types that the nodes and examples of the package publish, except texts, which add nothing.
/// `T_picture_header`: the pose of the marker's header frame in the picture's frame. `axes`: of the
/// camera, as in Camera. Throws InputError if the marker is illegal or of another type; then
/// nothing is added.
void add_marker(const visualization_msgs::Marker& marker, const Eigen::Isometry3d& T_picture_header,
                const Eigen::Matrix3d& axes, PictureTriangles& picture);

/// The unit normal of each corner of triangles, for the light. Each three consecutive points are a
/// triangle, with its outward normal by the right-hand rule. Faces that meet at a point with a
/// small angle between them share their normal there, so a curved surface looks smooth and an edge
/// stays sharp. A degenerate triangle has zero normals.
std::vector<Eigen::Vector3d> smooth_normals(const std::vector<Eigen::Vector3d>& triangles);

}  // namespace organ_collision
