#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gl_context.hpp"
#include "picking/culling/draw_list.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// Makes GL clip to a viewing volume, for vertices in the volume's shifted coordinates, until the
/// next call. Of the earlier GL state, it relies only on the matrix mode and the projection of a
/// new GlContext, and on its user planes, which are all enabled.
void clip_to(const ViewingVolume& volume, const GlFunctions& gl);

/// Makes GL's DrawArrays draw the corners of `faces`, with their numbers as texture coordinates,
/// until the next call. There must be some, and they must stay where they are.
void draw_from(const DrawnFaces& faces, const GlFunctions& gl);

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

/// Each draw has one more face last, which is in view: the witness. Where GL does not return it, GL
/// may be blind, and that it returned no other face means nothing. This is the number of the
/// witness, which no face of an organ has.
inline constexpr std::uint32_t kWitness = 0xffffffff;

/// To be called if GL has not returned the witness. Fails unless GL, in the context as it is,
/// returns a face across a volume of 2 m by 2 m by 2 m. If it does, either something disturbed only
/// that draw, or the volume is so thin that the witness was lost in rounding.
void fail_if_blind(GlContext& context);

}  // namespace organ_collision
