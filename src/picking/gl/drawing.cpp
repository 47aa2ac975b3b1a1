#include "drawing.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

namespace organ_collision {
namespace {

// [1] The size of the largest buffer: GL counts its floats with an integer.
constexpr std::size_t kMostFloats = std::numeric_limits<GLsizei>::max();

/// [1] The number of floats of a pass-through token with its value.
constexpr std::size_t kMarkFloats = 2;

/// [1] How many floats GL can return at most for `faces` faces, each after a pass-through token.
/// Each plane adds at most one corner to a face. GL may return a polygon of n corners as n - 2
/// triangles, each with two floats of its own.
std::size_t most_floats(std::size_t faces) {
  constexpr std::size_t kPlanes = 6 + ViewingVolume::kMaxUserPlanes;
  constexpr std::size_t kTriangle = 2 + 3 * kVertexFloats;
  return faces * (kMarkFloats + (1 + kPlanes) * kTriangle);
}

/// Runs `draw`, which draws `faces` faces, in GL_FEEDBACK mode. Enlarges `buffer` until everything
/// fits. Returns the number of floats that GL wrote.
template <typename Draw>
std::size_t feed_back(GlContext& context, std::size_t faces, std::vector<float>& buffer,
                      const Draw& draw) {
  const GlFunctions& gl = context.functions();
  while (true) {
    gl.FeedbackBuffer(static_cast<GLsizei>(buffer.size()), GL_3D_COLOR_TEXTURE, buffer.data());
    gl.RenderMode(GL_FEEDBACK);
    draw(gl);
    const GLint written = gl.RenderMode(GL_RENDER);
    context.check("a feedback query");
    if (written > static_cast<GLint>(buffer.size())) {
      context.fail("OpenGL claims to have written " + std::to_string(written) +
                   " floats to a buffer of " + std::to_string(buffer.size()));
    }
    if (written >= 0) return static_cast<std::size_t>(written);
    const std::size_t most = std::min(most_floats(faces), kMostFloats);
    if (buffer.size() >= most) {
      context.fail("OpenGL's feedback buffer is too small for " + std::to_string(faces) +
                   " faces with " + std::to_string(buffer.size()) + " floats");
    }
    buffer.resize(std::min(4 * buffer.size(), most));
  }
}

/// The first two barycentric coordinates of a vertex in a feedback buffer. Throws GlError if they
/// are far from all that rounding can give.
Eigen::Vector2d barycentrics_of(const float* vertex) {
  const auto is_share = [](float share) { return share >= -0.5F && share <= 1.5F; };
  if (is_share(vertex[7]) && is_share(vertex[8])) return {vertex[7], vertex[8]};
  throw GlError("OpenGL's feedback buffer holds illegal barycentric coordinates: " +
                std::to_string(vertex[7]) + ", " + std::to_string(vertex[8]));
}

/// Sorts the corners of a convex polygon along its border and drops those that occur twice. So the
/// triangles into which GL may split a polygon become one polygon again.
void sort_around_middle(FacePart& corners) {
  if (corners.empty()) return;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : corners) middle += corner;
  middle /= static_cast<double>(corners.size());
  const auto key = [&](const Eigen::Vector2d& corner) {
    const Eigen::Vector2d arm = corner - middle;
    return std::make_tuple(std::atan2(arm.y(), arm.x()), corner.x(), corner.y());
  };
  std::sort(corners.begin(), corners.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
}

std::uint32_t face_number(float lower, float upper) {
  return static_cast<std::uint32_t>(lower) | static_cast<std::uint32_t>(upper) << 16;
}

}  // namespace

void DrawnFaces::clear() {
  positions_.clear();
  numbers_.clear();
}

void DrawnFaces::add(const Triangle& face, std::uint32_t number) {
  const Number halves = {static_cast<float>(number & 0xffff), static_cast<float>(number >> 16)};
  add(face, {halves, halves, halves});
}

void DrawnFaces::add_with_barycentrics(const Triangle& face) {
  add(face, {{{1.0F, 0.0F}, {0.0F, 1.0F}, {0.0F, 0.0F}}});
}

void DrawnFaces::add(const Triangle& face, const std::array<Number, 3>& numbers) {
  std::array<Position, 3>& positions = positions_.emplace_back();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      positions[i][axis] = static_cast<float>(face[i][static_cast<Eigen::Index>(axis)]);
    }
  }
  numbers_.push_back(numbers);
}

std::uint32_t DrawnFaces::number(std::size_t face) const {
  const auto& [lower, upper] = numbers_[face].front();
  return face_number(lower, upper);
}

// The matrix clip() is loaded as the modelview matrix, and the projection stays the identity. GL's
// eye coordinates are then clip coordinates, in which the user planes are given. Otherwise GL would
// transform the planes by the inverse of the projection, in 32 bits, and lose the precision that
// shifted coordinates give.
const GlFunctions& prepare_to_draw(GlContext& context, const ViewingVolume& volume,
                                   const DrawnFaces& faces) {
  context.make_current();
  const GlFunctions& gl = context.functions();
  gl.LoadIdentity();
  // All user planes stay enabled, because Mesa takes some 20 ms to compile its vertex pipeline for
  // each new number of them. Unused planes are zero, so they clip nothing.
  const Eigen::Matrix4d clip_inverse = volume.clip().inverse();
  for (std::size_t i = 0; i < ViewingVolume::kMaxUserPlanes; ++i) {
    Eigen::RowVector4d plane = Eigen::RowVector4d::Zero();
    if (i < volume.user_plane_count()) plane = volume.user_planes()[i].transpose() * clip_inverse;
    gl.ClipPlane(GL_CLIP_PLANE0 + static_cast<GLenum>(i), plane.data());
  }
  gl.LoadMatrixd(volume.clip().data());
  // Positions and numbers have different strides on purpose. Mesa joins interleaved arrays of the
  // same stride to one vertex buffer. It stops doing so when the pointers have changed a few times,
  // as when arrays grow, and compiles its vertex pipeline anew: some 20 ms in the middle of a step.
  using Position = DrawnFaces::Position;
  using Number = DrawnFaces::Number;
  static_assert(sizeof(Position) != sizeof(Number));
  gl.VertexPointer(3, GL_FLOAT, sizeof(Position), faces.first_position().data());
  gl.TexCoordPointer(2, GL_FLOAT, sizeof(Number), faces.first_number().data());
  return gl;
}

std::uint32_t face_of(const float* vertex) {
  const auto is_half = [](float half) { return half >= 0.0f && half <= 65535.0f; };
  const float lower = vertex[7], upper = vertex[8];
  if (is_half(lower) && is_half(upper)) return face_number(lower, upper);
  throw GlError("OpenGL's feedback buffer holds an illegal face number: " + std::to_string(lower) +
                ", " + std::to_string(upper));
}

std::size_t draw_feedback(GlContext& context, const ViewingVolume& volume, const DrawnFaces& faces,
                          std::vector<float>& buffer) {
  prepare_to_draw(context, volume, faces);
  return feed_back(context, faces.size(), buffer, [&](const GlFunctions& gl) {
    gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * faces.size()));
  });
}

std::size_t draw_feedback_by_face(GlContext& context, const ViewingVolume& volume,
                                  const DrawnFaces& faces, std::vector<float>& buffer) {
  prepare_to_draw(context, volume, faces);
  return feed_back(context, faces.size(), buffer, [&](const GlFunctions& gl) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      gl.PassThrough(0.0F);
      gl.DrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * i), 3);
    }
  });
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
  const std::size_t room = (size - place) / kVertexFloats;
  if (vertices >= 0.0f && vertices <= static_cast<float>(room))
    return static_cast<std::size_t>(vertices);
  throw GlError("OpenGL's feedback buffer ends within a primitive of " + std::to_string(vertices) +
                " vertices");
}

std::vector<FacePart> read_parts(const std::vector<float>& buffer, std::size_t size) {
  std::vector<FacePart> parts;
  std::size_t place = 0;
  while (place < size) {
    if (buffer[place] == GL_PASS_THROUGH_TOKEN) {
      parts.emplace_back();
      place += kMarkFloats;
      continue;
    }
    for (std::size_t left = read_token(buffer, size, place); left > 0; --left) {
      if (parts.empty()) throw GlError("OpenGL's feedback buffer begins without a token of a face");
      parts.back().push_back(barycentrics_of(&buffer[place]));
      place += kVertexFloats;
    }
  }
  for (FacePart& part : parts) sort_around_middle(part);
  return parts;
}

void fail_if_blind(GlContext& context) {
  if (context.is_current()) {
    const ViewingVolume box =
        ViewingVolume::orthographic({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                     Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
    DrawnFaces face;
    face.add(middle_face(box), kWitness);
    std::vector<float> buffer(100);
    if (draw_feedback(context, box, face, buffer) > 0) return;
  }
  context.fail(
      "OpenGL does not return a face that is in view, so its answer means nothing: its context or "
      "framebuffer was lost or taken; the next query gets a new one");
}

}  // namespace organ_collision
