#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "picking/gl/gl_context.hpp"

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
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: the camera's x, y and z axes

  Eigen::Vector3d to_camera(const Eigen::Vector3d& point) const {
    return axes.transpose() * (point - eye);
  }
};

/// [rad] The vertical field of view, as in RViz.
inline constexpr double kFieldOfView = 0.785;

/// The centre of the box around the triangles, with its sides along the axes of the frame. There
/// must be a triangle.
Eigen::Vector3d centre(const PictureTriangles& triangles);

/// The smallest distance of the eye from `target` at which all triangles are in the picture, with a
/// margin around them. `aspect`: the width of the picture divided by its height.
double framing_distance(const PictureTriangles& triangles, const Eigen::Vector3d& target,
                        const Eigen::Matrix3d& axes, double aspect);

/// The projection of a camera whose picture contains depths from `near` to `far`: from camera
/// coordinates to GL's clip coordinates.
Eigen::Matrix4d projection(double aspect, double near, double far);

/// The colour of a lit surface, by the reflection models of Lambert and Blinn. The light comes from
/// above the viewer's left shoulder. `normal`: unit, in camera coordinates, on the side that the
/// viewer sees. The opacity is that of `colour`.
Colour lit(const Colour& colour, const Eigen::Vector3d& normal);

/// A picture of 8 bits a colour. Rows from top to bottom, with three bytes (red, green, blue) a
/// pixel.
struct Image {
  int width = 0, height = 0;  ///< [pixel]
  std::vector<std::uint8_t> pixels;
};

/// Writes a PNG file. Throws std::runtime_error, with one line that names the file, if it cannot be
/// written.
void write_png(const std::string& file, const Image& image);

/// [pixel] The largest width and height of a picture.
inline constexpr int kLongestSide = 4096;

/// Renders pictures with OpenGL, without a display. Each pixel is the mean of several samples, so
/// edges are smooth. Belongs to one thread.
class Renderer {
 public:
  /// The size of the pictures [pixel], at most kLongestSide. Throws GlError if OpenGL does not work
  /// in this process.
  Renderer(int width, int height);

  double aspect() const { return static_cast<double>(width_) / height_; }

  /// The triangles as the camera sees them, in front of the background (its opacity is ignored).
  /// Hidden parts are removed. Transparent triangles are drawn last, from the back to the front.
  /// The picture does not depend on the order of the triangles, unless two of them lie in one
  /// plane. Throws GlError.
  Image render(const PictureTriangles& triangles, const Camera& camera, const Colour& background);

 private:
  Image downsampled(const std::vector<std::uint8_t>& samples) const;

  int width_, height_;
  GlContext context_;
};

}  // namespace organ_collision
