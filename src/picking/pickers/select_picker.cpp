#include "select_picker.hpp"

#include <limits>
#include <string>

#include "candidates.hpp"
#include "picking/gl/clip_to.hpp"
#include "picking/gl/gl_functions.hpp"
#include "picking/gl/witness.hpp"
#include "picking/volumes/middle_face.hpp"

namespace organ_collision {
namespace {

// Length of a hit record with one name: number of names, least and greatest depth, name.
constexpr std::size_t kRecord = 4;

// Window depths of the near and the far plane. Mesa converts depths to 32-bit integers. The
// conversion wraps around for depths that rounding puts at 1 or outside [0, 1].
constexpr double kNearDepth = 0.25;
constexpr double kFarDepth = 0.75;

// Keeps window depths away from 0 and 1 as long as it lives.
class ScopedDepthRange {
 public:
  explicit ScopedDepthRange(const GlFunctions& gl) : gl_(gl) {
    gl_.DepthRange(kNearDepth, kFarDepth);
  }
  ~ScopedDepthRange() { gl_.DepthRange(0, 1); }
  ScopedDepthRange(const ScopedDepthRange&) = delete;
  ScopedDepthRange& operator=(const ScopedDepthRange&) = delete;

 private:
  const GlFunctions& gl_;
};

// The window depth of an entry of a hit record, in [0, 1] from near to far.
double window_depth(std::uint32_t recorded) {
  const double depth = recorded / static_cast<double>(std::numeric_limits<std::uint32_t>::max());
  return (depth - kNearDepth) / (kFarDepth - kNearDepth);
}

void draw_witness(const ViewingVolume& volume, const GlFunctions& gl) {
  gl.LoadName(kWitness);
  gl.Begin(GL_TRIANGLES);
  for (const Eigen::Vector3d& corner : middle_face(volume)) {
    gl.Vertex3fv(corner.cast<float>().eval().data());
  }
  gl.End();
}

}  // namespace

void SelectPicker::pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                        std::vector<Candidate>& candidates) {
  vertices_.resize(mesh.vertex_count());
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    vertices_[i] = (mesh.vertex(i) - volume.origin()).cast<float>();
  }
  const auto draw_named = [&](const GlFunctions& gl) {
    const std::vector<FaceIndices>& faces = mesh.faces();
    for (std::size_t i = 0; i < faces.size(); ++i) {
      gl.LoadName(static_cast<GLuint>(i));
      gl.Begin(GL_TRIANGLES);
      for (const std::uint32_t vertex : faces[i]) gl.Vertex3fv(vertices_[vertex].data());
      gl.End();
    }
  };
  if (!clip(volume, mesh.face_count(), draw_named, candidates)) {
    fail_if_blind(context_);
    clip(volume, mesh.face_count(), draw_named, candidates);
  }
  sort_returned(mesh.face_count(), context_, candidates);
}

void SelectPicker::pick(const PartSweep& part, const OrganMotion& organ,
                        std::vector<Candidate>& candidates) {
  const ViewingVolume volume = draw_list_.assign(part, organ);
  const std::vector<DrawVertex>& vertices = draw_list_.vertices();
  const auto draw_named = [&](const GlFunctions& gl) {
    for (std::size_t i = 0; i < vertices.size(); i += 3) {
      gl.LoadName(face_number(vertices[i].number[0], vertices[i].number[1]));
      gl.Begin(GL_TRIANGLES);
      for (std::size_t k = i; k < i + 3; ++k) gl.Vertex3fv(vertices[k].position.data());
      gl.End();
    }
  };
  if (!clip(volume, vertices.size() / 3, draw_named, candidates)) {
    fail_if_blind(context_);
    take_drawn(draw_list_, candidates);
  }
  add_undrawn(draw_list_, candidates);
  sort_returned(organ.after().face_count(), context_, candidates);
}

/// Replaces `candidates` by the faces that `draw_named(gl)` draws, `count` in all, and that meet
/// the volume. Returns whether GL also returned the witness, or nothing had to be drawn.
template <typename Draw>
bool SelectPicker::clip(const ViewingVolume& volume, std::size_t count, Draw draw_named,
                        std::vector<Candidate>& candidates) {
  candidates.clear();
  if (count == 0) return true;
  buffer_.resize(kRecord * (count + 1));
  context_.make_current();
  const GlFunctions& gl = context_.functions();
  clip_to(volume, gl);
  const std::size_t hits = select(gl, [&] {
    draw_named(gl);
    draw_witness(volume, gl);
  });
  read(hits, volume, candidates);
  return take_witness(candidates);
}

/// Returns the number of hit records of what `draw_all()` draws.
template <typename DrawAll>
std::size_t SelectPicker::select(const GlFunctions& gl, DrawAll draw_all) {
  const ScopedDepthRange scoped_depth_range(gl);
  gl.SelectBuffer(static_cast<GLsizei>(buffer_.size()), buffer_.data());
  gl.RenderMode(GL_SELECT);
  gl.InitNames();
  gl.PushName(0);
  draw_all();
  const GLint hits = gl.RenderMode(GL_RENDER);
  context_.check("a select query");
  if (hits >= 0 && kRecord * static_cast<std::size_t>(hits) <= buffer_.size()) {
    return static_cast<std::size_t>(hits);
  }
  context_.fail("OpenGL returns " + std::to_string(hits) + " hits, with space for " +
                std::to_string(buffer_.size() / kRecord));
}

/// Adds the faces of the first `hits` records.
void SelectPicker::read(std::size_t hits, const ViewingVolume& volume,
                        std::vector<Candidate>& candidates) const {
  for (std::size_t i = 0; i < hits; ++i) {
    const std::uint32_t* record = &buffer_[kRecord * i];
    candidates.push_back({record[3], volume.view_depth(window_depth(record[1])),
                          volume.view_depth(window_depth(record[2]))});
  }
}

}  // namespace organ_collision
