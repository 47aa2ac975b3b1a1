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
  /// The second and third barycentric coordinate in the face.
  Eigen::Vector2d barycentric() const { return {floats_[7], floats_[8]}; }
  std::uint32_t face() const { return face_number(floats_[9], floats_[10]); }

 private:
  const float* floats_;
};

/// Draws `vertices`, three a triangle, in GL_FEEDBACK mode, clipped to `volume`; makes the context
/// current. Fills `buffer`, which grows until all fits. Returns how many floats were written.
/// Throws GlError if GL did not work.
std::size_t draw_feedback(GlContext& context, const ViewingVolume& volume,
                          const std::vector<DrawVertex>& vertices, std::vector<float>& buffer);

/// Calls visit(vertex) for each vertex that the `size` floats of a feedback buffer hold, in the
/// order drawn. Throws GlError for what no triangle leaves behind.
template <typename Visit>
void for_each_vertex(const std::vector<float>& buffer, std::size_t size, Visit visit);

/// How many vertices follow the token at `place`, which moves on to the first of them.
std::size_t read_token(const std::vector<float>& buffer, std::size_t& place);

template <typename Visit>
void for_each_vertex(const std::vector<float>& buffer, std::size_t size, Visit visit) {
  std::size_t place = 0;
  while (place < size) {
    for (std::size_t left = read_token(buffer, place); left > 0; --left) {
      visit(FeedbackVertex(&buffer[place]));
      place += FeedbackVertex::kFloats;
    }
  }
}

}  // namespace organ_collision
