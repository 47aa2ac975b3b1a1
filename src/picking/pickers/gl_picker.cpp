#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "picker.hpp"
#include "picking/culling/outcodes.hpp"
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

// [1] A face is not drawn if it moves by more than kMostMove times the part's thickness, or if one
// of its coordinates exceeds kMostExtent times that thickness. For such a face, the volume would
// grow so much that many other faces would survive clipping. With kMostExtent the volume grows by
// 1% of the thickness, since 32-bit clipping loses a millionth of the largest coordinate.
constexpr double kMostMove = 0.5;
constexpr double kMostExtent = 0.01 / 1e-6;

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
    start(volume);
    const auto draw = [&](const FaceIndices& corners, std::uint32_t number) {
      faces_.add(shifted(mesh.triangle(corners), volume.origin()), number);
    };
    if (selects_) {
      for (std::uint32_t i = 0; i < mesh.face_count(); ++i) draw(mesh.faces()[i], i);
    } else {
      outcodes_.assign(volume, OrganMotion(mesh));
      outcodes_.for_each_face(
          [&](const FaceClusters::Face& face) { draw(face.corners, face.number); });
    }
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
    list_faces(part, organ);
    counts_.undrawn += undrawn_.size();
    add_witness();
    if (!clip(candidates)) {
      fail_if_blind(context_);
      // All drawn faces, except the witness, are candidates then. So no contact is missed.
      candidates.clear();
      for (std::size_t i = 0; i + 1 < faces_.size(); ++i) {
        candidates.push_back({faces_.number(i), 0.0, 0.0});
      }
    }
    for (const std::uint32_t face : undrawn_) candidates.push_back({face, 0.0, 0.0});
    sort(organ.after().face_count(), candidates);
  }

  void find_regions(const ViewingVolume& volume, const TriangleMesh& mesh,
                    const std::vector<Candidate>& candidates,
                    std::vector<Region>& regions) override {
    regions.clear();
    if (candidates.empty()) return;
    std::vector<FacePart> parts = draw_parts(volume, mesh, candidates);
    // GL has returned each of these faces before. If one is missing now, the draw was disturbed.
    const auto is_missing = [](const FacePart& part) { return part.empty(); };
    if (std::any_of(parts.begin(), parts.end(), is_missing)) {
      fail_if_blind(context_);
      parts = draw_parts(volume, mesh, candidates);
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto& [a, b, c] = mesh.triangle(candidates[i].face);
      Region& region = regions.emplace_back();
      for (const Eigen::Vector2d& at : parts[i]) {
        region.push_back(c + at.x() * (a - c) + at.y() * (b - c));
      }
    }
  }

  void release() override { context_.release(); }
  const std::string& gl_version() const override { return context_.version(); }

 private:
  void start(const ViewingVolume& volume) {
    volume_ = volume;
    faces_.clear();
    undrawn_.clear();
  }

  /// Lists the faces of an organ that may meet a part during their motion and that outcodes do not
  /// reject. Each face is drawn where it is half way. The volume contains the space that the part
  /// sweeps, grown by the largest distance of a drawn face from its place half way, and grown for
  /// 32-bit clipping. Some faces are not drawn: those with a corner inside, which meet the volume
  /// anyway, and those that move or reach so far that the volume would become large.
  void list_faces(const PartSweep& part, const OrganMotion& organ) {
    const Eigen::Vector3d& origin = part.origin();
    const double organ_extent = organ.extent(origin);
    const double most_extent = std::min(organ_extent, kMostExtent * part.thickness());
    const double most_move = kMostMove * part.thickness();
    double farthest_move = 0.0;
    start(part.volume({0.0, most_extent}));
    outcodes_.assign(*volume_, organ);
    outcodes_.for_each_face([&](const FaceClusters::Face& face) {
      if (outcodes_.has_corner_inside(face.corners)) return undrawn_.push_back(face.number);
      const FaceMotion motion = organ.face(face.corners);
      const double move = organ.rests() ? 0.0 : 0.5 * motion.farthest_move();
      const Triangle half_way = shifted(organ.rests() ? motion.end : motion.at(0.5), origin);
      if (move > most_move ||
          (organ_extent > most_extent && largest_coordinate(half_way) > most_extent)) {
        undrawn_.push_back(face.number);
      } else {
        farthest_move = std::max(farthest_move, move);
        faces_.add(half_way, face.number);
      }
    });
    if (farthest_move > 0.0) volume_ = part.volume({farthest_move, most_extent});
  }

  /// Adds the witness (see kWitness) as the last face that GL draws.
  void add_witness() {
    counts_.drawn += faces_.size();
    if (!faces_.empty()) faces_.add(middle_face(*volume_), kWitness);
  }

  /// Replaces `candidates` by the drawn faces that meet the volume. Returns whether GL returned the
  /// witness, too, or had nothing to draw.
  bool clip(std::vector<Candidate>& candidates) {
    candidates.clear();
    if (faces_.empty()) return true;
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
    const std::size_t size = draw_feedback(context_, *volume_, faces_, feedback_);
    try {
      for_each_vertex(feedback_, size, [&](std::uint32_t face, double window_depth) {
        const double depth = volume_->view_depth(window_depth);
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

  /// The part of each candidate's face in the volume.
  std::vector<FacePart> draw_parts(const ViewingVolume& volume, const TriangleMesh& mesh,
                                   const std::vector<Candidate>& candidates) {
    DrawnFaces drawn;
    for (const Candidate& candidate : candidates) {
      drawn.add_with_barycentrics(shifted(mesh.triangle(candidate.face), volume.origin()));
    }
    const std::size_t size = draw_feedback_by_face(context_, volume, drawn, feedback_);
    try {
      std::vector<FacePart> parts = read_parts(feedback_, size);
      if (parts.size() == candidates.size()) return parts;
      throw GlError("OpenGL returns " + std::to_string(parts.size()) + " tokens for " +
                    std::to_string(candidates.size()) + " faces");
    } catch (const GlError& error) {
      context_.fail(error.what());
    }
  }

  /// Adds the faces that GL returns in GL_SELECT mode, in the order drawn.
  void select(std::vector<Candidate>& candidates) {
    hits_.resize(kRecord * faces_.size());
    const std::size_t count = draw_named();
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t* const record = &hits_[kRecord * i];
      candidates.push_back({record[3], volume_->view_depth(window_depth(record[1])),
                            volume_->view_depth(window_depth(record[2]))});
    }
  }

  /// Draws each face under its own name, and returns the number of hits. Does not use glBegin and
  /// glEnd: in GL_SELECT mode, Mesa 22.3 then leaks buffers of 512 KB.
  std::size_t draw_named() {
    const GlFunctions& gl = prepare_to_draw(context_, *volume_, faces_);
    gl.DepthRange(kNearDepth, kFarDepth);
    gl.SelectBuffer(static_cast<GLsizei>(hits_.size()), hits_.data());
    gl.RenderMode(GL_SELECT);
    gl.InitNames();
    gl.PushName(0);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      gl.LoadName(faces_.number(i));
      gl.DrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * i), 3);
    }
    const GLint count = gl.RenderMode(GL_RENDER);
    context_.check("a select query");
    if (count >= 0 && kRecord * static_cast<std::size_t>(count) <= hits_.size()) {
      return static_cast<std::size_t>(count);
    }
    context_.fail("OpenGL returns " + std::to_string(count) + " hits, with space for " +
                  std::to_string(faces_.size()));
  }

  /// Sorts the candidates. Fails if a candidate's number is that of no face of the mesh.
  void sort(std::size_t face_count, std::vector<Candidate>& candidates) {
    sort_by_face(candidates);
    if (candidates.empty() || candidates.back().face < face_count) return;
    context_.fail("OpenGL returns face " + std::to_string(candidates.back().face) + " of " +
                  std::to_string(face_count));
  }

  GlContext context_;
  const bool selects_;                   ///< whether it draws in GL_SELECT mode
  std::optional<ViewingVolume> volume_;  ///< to which GL clips
  DrawnFaces faces_;                     ///< the faces that GL draws
  std::vector<std::uint32_t> undrawn_;   ///< candidates that are not drawn
  Outcodes outcodes_;
  std::vector<float> feedback_ = std::vector<float>(4096);
  std::vector<std::uint32_t> hits_;
};

}  // namespace

std::unique_ptr<Picker> new_gl_picker(const PickerSettings& settings) {
  return std::make_unique<GlPicker>(settings);
}

}  // namespace organ_collision
