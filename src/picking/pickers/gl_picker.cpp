#include <algorithm>
#include <limits>
#include <string>

#include "picker.hpp"
#include "picking/culling/draw_list.hpp"
#include "picking/gl/drawing.hpp"

namespace organ_collision {
namespace {

/// The number of entries of a hit record: number of names (1), least depth, greatest depth, name.
constexpr std::size_t kRecord = 4;

/// The window depths of the near and the far plane in GL_SELECT mode. They are not 0 and 1, because
/// Mesa's conversion to 32-bit integers overflows for depths that rounding puts at 1 or outside
/// [0, 1].
constexpr double kNearDepth = 0.25;
constexpr double kFarDepth = 0.75;

/// The depth in a hit record as a share of the range from near to far plane, in [0, 1].
double window_depth(std::uint32_t recorded) {
  const double depth = recorded / static_cast<double>(std::numeric_limits<std::uint32_t>::max());
  return (depth - kNearDepth) / (kFarDepth - kNearDepth);
}

class GlPicker final : public Picker {
 public:
  explicit GlPicker(const PickerSettings& settings)
      : context_(settings.gl), selects_(settings.kind == PickerKind::kSelect) {
    // Mesa compiles another vertex pipeline for the first draw in GL_FEEDBACK mode. Any later query
    // may call fail_if_blind(), which draws in that mode. It is called here, where it delays no
    // loop.
    if (selects_) fail_if_blind(context_);
  }

  void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
            std::vector<Candidate>& candidates) override {
    if (selects_) {
      draw_list_.assign_all(volume, mesh);
    } else {
      draw_list_.assign(volume, mesh);
    }
    counts_.drawn += faces().size();
    add_witness();
    if (!clip(candidates)) {
      fail_if_blind(context_);
      // If the witness is lost again, the volume is thin. The paper's modes then report what GL
      // returns.
      clip(candidates);
    }
    sort(mesh.face_count(), candidates);
  }

  void pick(const PartSweep& part, const OrganMotion& organ,
            std::vector<Candidate>& candidates) override {
    draw_list_.assign(part, organ);
    counts_.drawn += faces().size();
    counts_.undrawn += draw_list_.undrawn().size();
    add_witness();
    if (!clip(candidates)) {
      fail_if_blind(context_);
      take_drawn(candidates);  // So no contact is missed.
    }
    for (const std::uint32_t face : draw_list_.undrawn()) candidates.push_back({face, 0.0, 0.0});
    sort(organ.after().face_count(), candidates);
  }

  void release() override { context_.release(); }
  const std::string& gl_version() const override { return context_.version(); }

 private:
  const DrawnFaces& faces() const { return draw_list_.faces(); }

  /// Adds the witness (see kWitness) as the last face that GL draws.
  void add_witness() {
    if (!faces().empty()) draw_list_.add(middle_face(draw_list_.volume()), kWitness);
  }

  /// Replaces `candidates` by the faces of the draw list that meet the volume. Returns whether GL
  /// returned the witness, too, or had nothing to draw.
  bool clip(std::vector<Candidate>& candidates) {
    candidates.clear();
    if (faces().empty()) return true;
    if (selects_) {
      select(candidates);
    } else {
      feed_back(candidates);
    }
    if (candidates.empty() || candidates.back().face != kWitness) return false;
    candidates.pop_back();
    return true;
  }

  /// Adds the faces that GL returns in GL_FEEDBACK mode, in the order drawn. GL may split a face
  /// into several primitives, which follow each other.
  void feed_back(std::vector<Candidate>& candidates) {
    const ViewingVolume& volume = draw_list_.volume();
    const std::size_t size = draw_feedback(context_, volume, faces(), feedback_);
    try {
      for_each_vertex(feedback_, size, [&](std::uint32_t face, double window_depth) {
        const double depth = volume.view_depth(window_depth);
        if (candidates.empty() || candidates.back().face != face) {
          candidates.push_back({face, depth, depth});
        }
        Candidate& candidate = candidates.back();
        candidate.view_min = std::min(candidate.view_min, depth);
        candidate.view_max = std::max(candidate.view_max, depth);
      });
    } catch (const GlError& error) {
      context_.fail(error.what());
    }
  }

  /// Adds the faces that GL returns in GL_SELECT mode, in the order drawn.
  void select(std::vector<Candidate>& candidates) {
    const ViewingVolume& volume = draw_list_.volume();
    hits_.resize(kRecord * faces().size());
    const std::size_t count = draw_named();
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t* const record = &hits_[kRecord * i];
      candidates.push_back({record[3], volume.view_depth(window_depth(record[1])),
                            volume.view_depth(window_depth(record[2]))});
    }
  }

  /// Draws each face under its own name, and returns the number of hits. Does not use glBegin and
  /// glEnd: in GL_SELECT mode, Mesa 22.3 then leaks buffers of 512 KB.
  std::size_t draw_named() {
    const GlFunctions& gl = prepare_to_draw(context_, draw_list_.volume(), faces());
    gl.DepthRange(kNearDepth, kFarDepth);
    gl.SelectBuffer(static_cast<GLsizei>(hits_.size()), hits_.data());
    gl.RenderMode(GL_SELECT);
    gl.InitNames();
    gl.PushName(0);
    for (std::size_t i = 0; i < faces().size(); ++i) {
      gl.LoadName(faces().number(i));
      gl.DrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * i), 3);
    }
    const GLint count = gl.RenderMode(GL_RENDER);
    context_.check("a select query");
    if (count >= 0 && kRecord * static_cast<std::size_t>(count) <= hits_.size()) {
      return static_cast<std::size_t>(count);
    }
    context_.fail("OpenGL returns " + std::to_string(count) + " hits, with space for " +
                  std::to_string(faces().size()));
  }

  /// Replaces `candidates` by all faces of the draw list, except the witness.
  void take_drawn(std::vector<Candidate>& candidates) const {
    candidates.clear();
    for (std::size_t i = 0; i < faces().size(); ++i) {
      const std::uint32_t face = faces().number(i);
      if (face != kWitness) candidates.push_back({face, 0.0, 0.0});
    }
  }

  /// Sorts the candidates. Fails if a candidate's number is that of no face of the mesh.
  void sort(std::size_t face_count, std::vector<Candidate>& candidates) {
    sort_by_face(candidates);
    if (candidates.empty() || candidates.back().face < face_count) return;
    context_.fail("OpenGL returns face " + std::to_string(candidates.back().face) + " of " +
                  std::to_string(face_count));
  }

  GlContext context_;
  const bool selects_;  ///< whether it draws in GL_SELECT mode
  DrawList draw_list_;
  std::vector<float> feedback_ = std::vector<float>(4096);
  std::vector<std::uint32_t> hits_;
};

}  // namespace

std::unique_ptr<Picker> new_gl_picker(const PickerSettings& settings) {
  return std::make_unique<GlPicker>(settings);
}

}  // namespace organ_collision
