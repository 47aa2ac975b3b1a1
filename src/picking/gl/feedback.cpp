#include "feedback.hpp"

#include <limits>
#include <string>

#include "clip_to.hpp"
#include "gl_functions.hpp"

namespace organ_collision {

std::size_t draw_feedback(GlContext& context, const ViewingVolume& volume,
                          const std::vector<DrawVertex>& vertices, std::vector<float>& buffer) {
  if (vertices.empty()) return 0;
  context.make_current();
  const GlFunctions& gl = context.functions();
  clip_to(volume, gl);
  constexpr GLsizei kStride = sizeof(DrawVertex);
  static_assert(offsetof(DrawVertex, number) == offsetof(DrawVertex, barycentric) + 8,
                "barycentric and number make one texture coordinate");
  gl.VertexPointer(3, GL_FLOAT, kStride, vertices.data()->position.data());
  gl.TexCoordPointer(4, GL_FLOAT, kStride, vertices.data()->barycentric.data());
  while (true) {
    gl.FeedbackBuffer(static_cast<GLsizei>(buffer.size()), GL_3D_COLOR_TEXTURE, buffer.data());
    gl.RenderMode(GL_FEEDBACK);
    gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
    const GLint written = gl.RenderMode(GL_RENDER);
    context.check("a feedback query");
    if (written >= 0) return static_cast<std::size_t>(written);
    if (buffer.size() > std::numeric_limits<GLsizei>::max() / 4) {
      throw GlError("OpenGL's feedback buffer cannot hold what was picked: too many faces");
    }
    buffer.resize(4 * buffer.size());
  }
}

std::size_t read_token(const std::vector<float>& buffer, std::size_t& place) {
  const float token = buffer[place++];
  if (token == GL_POLYGON_TOKEN) return static_cast<std::size_t>(buffer[place++]);
  if (token == GL_LINE_TOKEN || token == GL_LINE_RESET_TOKEN) return 2;
  if (token == GL_POINT_TOKEN) return 1;
  throw GlError("OpenGL's feedback buffer holds an unknown token: " + std::to_string(token));
}

}  // namespace organ_collision
