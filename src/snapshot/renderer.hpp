#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "camera.hpp"
#include "image.hpp"
#include "picking/gl/gl_context.hpp"
#include "picture.hpp"
#include "render_functions.hpp"

namespace organ_collision {

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
  RenderFunctions gl_;
};

}  // namespace organ_collision
