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

/// A face that meets a viewing volume, with the range of its depths behind the near plane, along
/// the view [m].
struct Candidate {
  std::uint32_t face;
  double view_min;
  double view_max;
};

/// Finds the faces that meet a viewing volume by drawing them in one of GL's picking modes.
class Picker {
 public:
  virtual ~Picker() = default;

  /// Replaces `candidates` by the faces of `mesh` that meet `volume`, each once, sorted by number.
  /// Makes the context current. Throws GlError if GL did not work: there is no answer then, which
  /// is not the same as no candidate.
  virtual void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                    std::vector<Candidate>& candidates) = 0;

  /// Replaces `candidates` by the faces of `organ` that may meet the space that `part` sweeps, each
  /// once, sorted by number. Contains every face that does. The depth ranges have no meaning. Makes
  /// the context current, and throws, as above.
  virtual void pick(const PartSweep& part, const OrganMotion& organ,
                    std::vector<Candidate>& candidates) = 0;
};

/// Makes a picker that draws in `context`, which must outlive it. First tests it with three faces,
/// only one of them in view. Throws GlError if it picks wrongly.
std::unique_ptr<Picker> make_picker(PickerKind kind, GlContext& context);

}  // namespace organ_collision
