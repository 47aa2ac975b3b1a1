#include "draw_from.hpp"

namespace organ_collision {

void draw_from(const std::vector<DrawVertex>& vertices, const GlFunctions& gl) {
  constexpr GLsizei kStride = sizeof(DrawVertex);
  gl.VertexPointer(3, GL_FLOAT, kStride, vertices.data()->position.data());
  gl.TexCoordPointer(2, GL_FLOAT, kStride, vertices.data()->number.data());
}

}  // namespace organ_collision
