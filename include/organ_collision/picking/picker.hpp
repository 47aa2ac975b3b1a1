#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ_motion.hpp"
#include "organ_collision/geometry/triangle_mesh.hpp"
#include "organ_collision/picking/gl_context.hpp"
#include "organ_collision/picking/part_sweep.hpp"
#include "organ_collision/picking/viewing_volume.hpp"

namespace organ_collision {

/// A face that survived GL's clipping to a viewing volume, with its depth range along the view,
/// behind the near plane [m].
struct Candidate {
  std::uint32_t face;
  double view_min;
  double view_max;
};

/// Finds the faces that meet a viewing volume by drawing them in one of GL's picking modes.
class Picker {
 public:
  virtual ~Picker() = default;

  /// Replaces `candidates` by the faces of `mesh` that meet `volume`, by rising number, each once.
  /// Makes the context current. Throws GlError if GL did not work: no answer, not an empty one.
  virtual void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                    std::vector<Candidate>& candidates) = 0;

  /// Replaces `candidates` by at least the faces of `organ` that come within the space that `part`
  /// sweeps, by rising number, each once; their depth range means nothing. Otherwise the same.
  virtual void pick(const PartSweep& part, const OrganMotion& organ,
                    std::vector<Candidate>& candidates) = 0;
};

enum class PickerKind {
  kFeedback,  ///< GL_FEEDBACK: one draw call, the face number as a vertex attribute
  kSelect     ///< GL_SELECT: the paper's, a name for each face
};

/// "feedback" or "select"; throws std::invalid_argument naming both for anything else.
PickerKind picker_kind(const std::string& name);

/// A picker that draws in `context`, which must outlive it. Picks a face known to hit and one known
/// to miss; throws GlError if either comes out wrong.
std::unique_ptr<Picker> make_picker(PickerKind kind, GlContext& context);

}  // namespace organ_collision
