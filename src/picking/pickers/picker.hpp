#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/picking/picker_kind.hpp"
#include "picking/gl/gl_context.hpp"
#include "picking/volumes/part_sweep.hpp"
#include "picking/volumes/viewing_volume.hpp"

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

/// A picker that draws in `context`, which must outlive it. Picks a face known to hit and one known
/// to miss; throws GlError if either comes out wrong.
std::unique_ptr<Picker> make_picker(PickerKind kind, GlContext& context);

}  // namespace organ_collision
