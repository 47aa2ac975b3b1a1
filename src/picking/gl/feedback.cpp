#include "feedback.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "clip_to.hpp"
#include "draw_from.hpp"
#include "gl_functions.hpp"

namespace organ_collision {
namespace {

// [1] GL counts the floats of a buffer with an integer.
constexpr std::size_t kMostFloats = std::numeric_limits<GLsizei>::max();

/// [1] What GL can return at most for a number of faces. Each plane adds at most one corner to a
/// face, and GL may return a polygon of n corners as n - 2 triangles, each with two floats of its
/// own.
std::size_t most_floats(std::size_t faces) {
  constexpr std::size_t kPlanes = 6 + ViewingVolume::kMaxUserPlanes;
  constexpr std::size_t kTriangle = 2 + 3 * FeedbackVertex::kFloats;
  return faces * (1 + kPlanes) * kTriangle;
}

}  // namespace

std::uint32_t FeedbackVertex::face() const {
  const auto is_half = [](float half) { return half >= 0.0f && half <= 65535.0f; };
  const float lower = floats_[7], upper = floats_[8];
  if (is_half(lower) && is_half(upper)) return face_number(lower, upper);
  throw GlError("OpenGL's feedback buffer holds an illegal face number: " + std::to_string(lower) +
                ", " + std::to_string(upper));
}

std::size_t draw_feedback(GlContext& context, const ViewingVolume& volume, const DrawnFaces& faces,
                          std::vector<float>& buffer) {
  context.make_current();
  const GlFunctions& gl = context.functions();
  clip_to(volume, gl);
  draw_from(faces, gl);
  while (true) {
    gl.FeedbackBuffer(static_cast<GLsizei>(buffer.size()), GL_3D_COLOR_TEXTURE, buffer.data());
    gl.RenderMode(GL_FEEDBACK);
    gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * faces.size()));
    const GLint written = gl.RenderMode(GL_RENDER);
    context.check("a feedback query");
    if (written > static_cast<GLint>(buffer.size())) {
      context.fail("OpenGL claims to have written " + std::to_string(written) +
                   " floats to a buffer of " + std::to_string(buffer.size()));
    }
    if (written >= 0) return static_cast<std::size_t>(written);
    const std::size_t most = std::min(most_floats(faces.size()), kMostFloats);
    if (buffer.size() >= most) {
      context.fail("OpenGL's feedback buffer is too small for " + std::to_string(faces.size()) +
                   " faces with " + std::to_string(buffer.size()) + " floats");
    }
    buffer.resize(std::min(4 * buffer.size(), most));
  }
}

std::size_t read_token(const std::vector<float>& buffer, std::size_t size, std::size_t& place) {
  const float token = buffer[place++];
  float vertices = 0.0f;
  if (token == GL_POLYGON_TOKEN) {
    vertices = place < size ? buffer[place++] : -1.0f;
  } else if (token == GL_LINE_TOKEN || token == GL_LINE_RESET_TOKEN) {
    vertices = 2.0f;
  } else if (token == GL_POINT_TOKEN) {
    vertices = 1.0f;
  } else {
    throw GlError("OpenGL's feedback buffer holds an unknown token: " + std::to_string(token));
  }
  const std::size_t room = (size - place) / FeedbackVertex::kFloats;
  if (vertices >= 0.0f && vertices <= static_cast<float>(room))
    return static_cast<std::size_t>(vertices);
  throw GlError("OpenGL's feedback buffer ends within a primitive of " + std::to_string(vertices) +
                " vertices");
}

}  // namespace organ_collision
