#include "select_picker.hpp"

#include <limits>

#include "candidates.hpp"
#include "picking/gl/clip_to.hpp"
#include "picking/gl/gl_functions.hpp"

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

}  // namespace

void SelectPicker::pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                        std::vector<Candidate>& candidates) {
  vertices_.resize(mesh.vertex_count());
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    vertices_[i] = (mesh.vertex(i) - volume.origin()).cast<float>();
  }
  candidates.clear();
  const auto draw_named = [&](const GlFunctions& gl) {
    const std::vector<FaceIndices>& faces = mesh.faces();
    for (std::size_t i = 0; i < faces.size(); ++i) {
      gl.LoadName(static_cast<GLuint>(i));
      gl.Begin(GL_TRIANGLES);
      for (const std::uint32_t vertex : faces[i]) gl.Vertex3fv(vertices_[vertex].data());
      gl.End();
    }
  };
  select(volume, draw_named, candidates);
}

void SelectPicker::pick(const PartSweep& part, const OrganMotion& organ,
                        std::vector<Candidate>& candidates) {
  const ViewingVolume volume = draw_list_.assign(part, organ);
  candidates.clear();
  add_undrawn(draw_list_, candidates);
  const auto draw_named = [&](const GlFunctions& gl) {
    const std::vector<DrawVertex>& vertices = draw_list_.vertices();
    for (std::size_t i = 0; i < vertices.size(); i += 3) {
      gl.LoadName(face_number(vertices[i].number[0], vertices[i].number[1]));
      gl.Begin(GL_TRIANGLES);
      for (std::size_t k = i; k < i + 3; ++k) gl.Vertex3fv(vertices[k].position.data());
      gl.End();
    }
  };
  select(volume, draw_named, candidates);
  sort_by_face(candidates);
}

/// Adds the faces that `draw_named(gl)` draws and that meet the volume.
template <typename Draw>
void SelectPicker::select(const ViewingVolume& volume, Draw draw_named,
                          std::vector<Candidate>& candidates) {
  context_.make_current();
  const GlFunctions& gl = context_.functions();
  clip_to(volume, gl);
  const ScopedDepthRange scoped_depth_range(gl);
  GLint hits = -1;
  while (hits < 0) {
    gl.SelectBuffer(static_cast<GLsizei>(buffer_.size()), buffer_.data());
    gl.RenderMode(GL_SELECT);
    gl.InitNames();
    gl.PushName(0);
    draw_named(gl);
    hits = gl.RenderMode(GL_RENDER);
    context_.check("a select query");
    if (hits < 0) buffer_.resize(4 * buffer_.size());
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(hits); ++i) {
    const std::uint32_t* record = &buffer_[kRecord * i];
    candidates.push_back({record[3], volume.view_depth(window_depth(record[1])),
                          volume.view_depth(window_depth(record[2]))});
  }
}

}  // namespace organ_collision
