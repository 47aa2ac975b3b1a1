#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gl_context.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// Faces as GL reads them. Each corner has the number of its face as a texture coordinate, which GL
/// returns. Positions and numbers are two arrays with different strides: see prepare_to_draw().
class DrawnFaces {
 public:
  using Position = std::array<float, 3>;  ///< in the volume's shifted coordinates [m]
  using Number = std::array<float, 2>;    ///< the lower and upper 16 bits; floats hold both exactly

  void clear();
  /// Adds a face in the volume's shifted coordinates.
  void add(const Triangle& face, std::uint32_t number);
  /// The same. Instead of a number, each corner has its first two barycentric coordinates.
  void add_with_barycentrics(const Triangle& face);

  bool empty() const { return positions_.empty(); }
  std::size_t size() const { return positions_.size(); }
  std::uint32_t number(std::size_t face) const;

  /// The arrays for GL, with an element for each corner. There must be some faces.
  const Position& first_position() const { return positions_.front().front(); }
  const Number& first_number() const { return numbers_.front().front(); }

 private:
  void add(const Triangle& face, const std::array<Number, 3>& numbers);

  std::vector<std::array<Position, 3>> positions_;
  std::vector<std::array<Number, 3>> numbers_;
};

/// Makes the context current. Until the next call, GL clips to `volume`, and DrawArrays draws the
/// corners of `faces`, with the faces' numbers as texture coordinates. `faces` must not be empty
/// and must not change meanwhile. Relies on the matrix mode, the projection and the enabled user
/// planes of a new GlContext. Throws GlError.
const GlFunctions& prepare_to_draw(GlContext& context, const ViewingVolume& volume,
                                   const DrawnFaces& faces);

/// Draws `faces`, which must not be empty, in GL_FEEDBACK mode, clipped to `volume`. Makes the
/// context current. Enlarges `buffer` until everything fits. Returns the number of floats that GL
/// wrote. Throws GlError if GL did not work.
std::size_t draw_feedback(GlContext& context, const ViewingVolume& volume, const DrawnFaces& faces,
                          std::vector<float>& buffer);

/// The same for faces with barycentric coordinates: draws them one by one, each after a
/// pass-through token. read_parts() reads what GL returns.
std::size_t draw_feedback_by_face(GlContext& context, const ViewingVolume& volume,
                                  const DrawnFaces& faces, std::vector<float>& buffer);

/// The number of floats of a vertex in a feedback buffer. GL_3D_COLOR_TEXTURE gives window x y z,
/// color r g b a, texture coordinate s t r q.
inline constexpr std::size_t kVertexFloats = 11;

/// The number of the face to which a vertex in a feedback buffer belongs. Throws GlError if the
/// vertex holds no legal number.
std::uint32_t face_of(const float* vertex);

/// The number of vertices that follow the token at `place` < `size`. Advances `place` to the first
/// vertex. Throws GlError if the vertices do not end within the first `size` floats.
std::size_t read_token(const std::vector<float>& buffer, std::size_t size, std::size_t& place);

/// Calls visit(face, depth) for each vertex in the first `size` floats of a feedback buffer, in the
/// order drawn. `depth` is GL's window depth, in [0, 1]. Throws GlError for a token that clipped
/// triangles cannot produce, for an illegal face, and if the buffer ends within a primitive. `size`
/// is at most that of the buffer.
template <typename Visit>
void for_each_vertex(const std::vector<float>& buffer, std::size_t size, Visit visit) {
  std::size_t place = 0;
  while (place < size) {
    for (std::size_t left = read_token(buffer, size, place); left > 0; --left) {
      visit(face_of(&buffer[place]), double{buffer[place + 2]});
      place += kVertexFloats;
    }
  }
}

/// The part of a face that survives clipping, a convex polygon: the first two barycentric
/// coordinates of its corners, in their order along its border. Empty if nothing survives.
using FacePart = std::vector<Eigen::Vector2d>;

/// The parts of the faces that draw_feedback_by_face() has drawn, in the order drawn, from the
/// first `size` floats of a feedback buffer. Throws GlError as for_each_vertex() does.
std::vector<FacePart> read_parts(const std::vector<float>& buffer, std::size_t size);

/// The number of the witness. The witness is a face in view that is drawn last. If GL does not
/// return it, GL may be blind: its answer then means nothing. No face of an organ has this number.
inline constexpr std::uint32_t kWitness = 0xffffffff;

/// To be called if GL has not returned the witness. Fails if GL, in the present context, does not
/// return a face across a volume of 2 m by 2 m by 2 m. Does not fail if only the last draw was
/// disturbed, or if its volume was so thin that the witness was lost in rounding.
void fail_if_blind(GlContext& context);

}  // namespace organ_collision
