#pragma once

#include <cstddef>
#include <vector>

#include "gl_context.hpp"
#include "picking/culling/draw_list.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// A vertex in a feedback buffer, as GL writes it for GL_3D_COLOR_TEXTURE: window x y z, color r g
/// b a, texture coordinate s t r q.
class FeedbackVertex {
 public:
  static constexpr std::size_t kFloats = 11;

  explicit FeedbackVertex(const float* floats) : floats_(floats) {}

  /// GL's depth in [0, 1].
  double window_depth() const { return floats_[2]; }
  /// The number of the face, as in DrawnFaces. Throws GlError if it cannot be one.
  std::uint32_t face() const;

 private:
  const float* floats_;
};

/// Draws `faces` in GL_FEEDBACK mode, clipped to `volume`. There must be some. Makes the context
/// current. Enlarges `buffer` until everything fits. Returns the number of floats written to it.
/// Throws GlError if GL did not work.
std::size_t draw_feedback(GlContext& context, const ViewingVolume& volume, const DrawnFaces& faces,
                          std::vector<float>& buffer);

/// Calls visit(vertex) for each vertex in the first `size` floats of a feedback buffer, in the
/// order drawn. Throws GlError for a token that clipped triangles cannot produce, and if the buffer
/// ends within a primitive. `size` is at most that of the buffer.
template <typename Visit>
void for_each_vertex(const std::vector<float>& buffer, std::size_t size, Visit visit);

/// The number of vertices that follow the token at `place` < `size`. Advances `place` to the first
/// of them. All of them are within the first `size` floats, otherwise throws GlError.
std::size_t read_token(const std::vector<float>& buffer, std::size_t size, std::size_t& place);

template <typename Visit>
void for_each_vertex(const std::vector<float>& buffer, std::size_t size, Visit visit) {
  std::size_t place = 0;
  while (place < size) {
    for (std::size_t left = read_token(buffer, size, place); left > 0; --left) {
      visit(FeedbackVertex(&buffer[place]));
      place += FeedbackVertex::kFloats;
    }
  }
}

}  // namespace organ_collision
