#include "gl_picker.hpp"

#include <limits>

namespace organ_collision {

void FeedbackPicker::pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                          std::vector<Candidate>& candidates) {
  draw_list_.assign(volume, mesh);
  add_witness(volume, draw_list_);
  if (!clip(volume, candidates)) {
    fail_if_blind(context_);
    clip(volume, candidates);
  }
  sort_returned(mesh.face_count(), context_, candidates);
}

void FeedbackPicker::pick(const PartSweep& part, const OrganMotion& organ,
                          std::vector<Candidate>& candidates) {
  const ViewingVolume volume = draw_list_.assign(part, organ);
  add_witness(volume, draw_list_);
  if (!clip(volume, candidates)) {
    fail_if_blind(context_);
    take_drawn(draw_list_, candidates);
  }
  add_undrawn(draw_list_, candidates);
  sort_returned(organ.after().face_count(), context_, candidates);
}

/// Replaces `candidates` by the faces of the draw list that meet the volume. Returns whether GL
/// also returned the witness, which is the last one in the list, or nothing had to be drawn.
bool FeedbackPicker::clip(const ViewingVolume& volume, std::vector<Candidate>& candidates) {
  candidates.clear();
  if (draw_list_.faces().empty()) return true;
  const std::size_t size = draw_feedback(context_, volume, draw_list_.faces(), buffer_);
  try {
    read(size, volume, candidates);
  } catch (const GlError& error) {
    context_.fail(error.what());
  }
  return take_witness(candidates);
}

/// Adds all faces in the first `size` floats of the buffer.
void FeedbackPicker::read(std::size_t size, const ViewingVolume& volume,
                          std::vector<Candidate>& candidates) const {
  // Faces come back in the order drawn. If GL has split a face into several primitives, they follow
  // each other.
  for_each_vertex(buffer_, size, [&](const FeedbackVertex& vertex) {
    const double depth = volume.view_depth(vertex.window_depth());
    if (candidates.empty() || candidates.back().face != vertex.face()) {
      candidates.push_back({vertex.face(), depth, depth});
    }
    Candidate& candidate = candidates.back();
    candidate.view_min = std::min(candidate.view_min, depth);
    candidate.view_max = std::max(candidate.view_max, depth);
  });
}

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

/// Draws each face under its own name. Not by glBegin and glEnd: in GL_SELECT mode, Mesa 22.3 loses
/// a buffer of 512 KB whenever such vertices have filled it.
void draw_named(const DrawnFaces& faces, const GlFunctions& gl) {
  draw_from(faces, gl);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    gl.LoadName(faces.number(i));
    gl.DrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * i), 3);
  }
}

}  // namespace

// Mesa compiles another vertex pipeline for the first draw in GL_FEEDBACK mode, which
// fail_if_blind() may do in any query. Here it stalls no loop.
SelectPicker::SelectPicker(GlContext context) : context_(std::move(context)) {
  fail_if_blind(context_);
}

void SelectPicker::pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                        std::vector<Candidate>& candidates) {
  draw_list_.assign_all(volume, mesh);
  add_witness(volume, draw_list_);
  if (!clip(volume, candidates)) {
    fail_if_blind(context_);
    clip(volume, candidates);
  }
  sort_returned(mesh.face_count(), context_, candidates);
}

void SelectPicker::pick(const PartSweep& part, const OrganMotion& organ,
                        std::vector<Candidate>& candidates) {
  const ViewingVolume volume = draw_list_.assign(part, organ);
  add_witness(volume, draw_list_);
  if (!clip(volume, candidates)) {
    fail_if_blind(context_);
    take_drawn(draw_list_, candidates);
  }
  add_undrawn(draw_list_, candidates);
  sort_returned(organ.after().face_count(), context_, candidates);
}

/// Replaces `candidates` by the faces of the draw list that meet the volume. Returns whether GL
/// also returned the witness, which is the last one in the list, or nothing had to be drawn.
bool SelectPicker::clip(const ViewingVolume& volume, std::vector<Candidate>& candidates) {
  candidates.clear();
  if (draw_list_.faces().empty()) return true;
  buffer_.resize(kRecord * draw_list_.faces().size());
  context_.make_current();
  clip_to(volume, context_.functions());
  read(select(context_.functions()), volume, candidates);
  return take_witness(candidates);
}

/// Draws the list. Returns the number of hit records.
std::size_t SelectPicker::select(const GlFunctions& gl) {
  const ScopedDepthRange scoped_depth_range(gl);
  gl.SelectBuffer(static_cast<GLsizei>(buffer_.size()), buffer_.data());
  gl.RenderMode(GL_SELECT);
  gl.InitNames();
  gl.PushName(0);
  draw_named(draw_list_.faces(), gl);
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
