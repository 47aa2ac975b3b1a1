#pragma once

#include <GL/gl.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "camera.hpp"
#include "picking/gl/gl_context.hpp"

namespace organ_collision {

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

}  // namespace organ_collision

// Every GL function that the renderer calls, without its gl prefix.
// clang-format off
#define ORGAN_COLLISION_RENDER_FUNCTIONS(F)                                                  \
  F(BlendFunc) F(Clear) F(ClearColor) F(ColorPointer) F(DepthMask) F(DisableClientState)     \
  F(DrawArrays) F(Enable) F(EnableClientState) F(LoadMatrixd) F(ReadPixels) F(VertexPointer)
// clang-format on

namespace organ_collision {

/// Pointers to these functions, loaded from a context as the pickers load theirs.
struct RenderFunctions {
#define ORGAN_COLLISION_DECLARE(name) decltype(&gl##name) name = nullptr;
  ORGAN_COLLISION_RENDER_FUNCTIONS(ORGAN_COLLISION_DECLARE)
#undef ORGAN_COLLISION_DECLARE
};

/// Loads all these functions. Throws GlError, naming the first one that is missing.
RenderFunctions load_render_functions(const GlContext& context);

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
