#pragma once

#include <Eigen/Core>
#include <vector>

namespace organ_collision {

/// Red, green, blue and opacity, each from 0 to 1.
using Colour = Eigen::Vector4f;

struct PictureVertex {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< outward, for the light; zero: the colour is shown as it is
  Colour colour;
};

/// All that a picture shows, in one frame [m]: each three consecutive vertices are a triangle.
using PictureTriangles = std::vector<PictureVertex>;

/// A perspective camera. Camera coordinates: x to the right, y upwards, z towards the viewer.
struct Camera {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: camera's x, y, z in the frame

  Eigen::Vector3d to_camera(const Eigen::Vector3d& point) const {
    return axes.transpose() * (point - eye);
  }
};

/// [rad] The vertical field of view, as in RViz.
inline constexpr double kFieldOfView = 0.785;

/// The axes of a camera that looks against `to_eye` (not zero). y is close to `up`; where both are
/// parallel, it is close to a frame axis instead.
Eigen::Matrix3d view_axes(const Eigen::Vector3d& to_eye, const Eigen::Vector3d& up);

/// The centre of the box around the triangles, which is aligned with the frame. There must be a
/// triangle.
Eigen::Vector3d centre(const PictureTriangles& triangles);

/// The smallest distance of the eye from `target` at which all triangles are in the picture, with a
/// margin around them. `aspect`: width of the picture by its height.
double framing_distance(const PictureTriangles& triangles, const Eigen::Vector3d& target,
                        const Eigen::Matrix3d& axes, double aspect);

/// The projection of a camera whose picture contains depths from `near` to `far`: from camera
/// coordinates to GL's clip coordinates.
Eigen::Matrix4d projection(double aspect, double near, double far);

}  // namespace organ_collision
