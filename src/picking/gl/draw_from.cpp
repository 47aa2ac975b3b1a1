#include "draw_from.hpp"

namespace organ_collision {

// Mesa joins arrays that are interleaved, with the same stride, to one vertex buffer. It stops
// doing so when the pointers have changed a few times, as they do when the arrays grow. It then
// compiles its vertex pipeline anew, for some 20 ms in the middle of a step. Arrays with different
// strides are never joined, so that one pipeline is enough.
void draw_from(const DrawnFaces& faces, const GlFunctions& gl) {
  using Position = DrawnFaces::Position;
  using Number = DrawnFaces::Number;
  static_assert(sizeof(Position) != sizeof(Number));
  gl.VertexPointer(3, GL_FLOAT, sizeof(Position), faces.first_position().data());
  gl.TexCoordPointer(2, GL_FLOAT, sizeof(Number), faces.first_number().data());
}

}  // namespace organ_collision
