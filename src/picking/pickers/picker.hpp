#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/picking/picker_settings.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// A face that meets a viewing volume. `view_min` and `view_max` [m] are the least and the greatest
/// depth of the part in the volume, along the view from the near plane.
struct Candidate {
  std::uint32_t face;
  double view_min;
  double view_max;
};

void sort_by_face(std::vector<Candidate>& candidates);

/// Finds the faces that meet a viewing volume. Belongs to one thread at a time.
class Picker {
 public:
  virtual ~Picker() = default;

  /// Replaces `candidates` by the faces of `mesh` that meet `volume`, each once, sorted by number.
  /// Throws GlError if GL did not work: there is no answer then, which is not the same as no
  /// candidate.
  virtual void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
                    std::vector<Candidate>& candidates) = 0;

  /// Replaces `candidates` by the faces of `organ` that may meet the space that `part` sweeps, each
  /// once, sorted by number. Contains every face that does. The view_min and view_max of the
  /// candidates have no meaning. Throws GlError.
  virtual void pick(const PartSweep& part, const OrganMotion& organ,
                    std::vector<Candidate>& candidates) = 0;

  /// Replaces `regions` by the part of each candidate's face in `volume`, in the same order. The
  /// candidates are those of pick() for the same volume and mesh. With OpenGL, GL_FEEDBACK gives
  /// the regions, in 32 bits; otherwise they are exact. Throws GlError.
  virtual void find_regions(const ViewingVolume& volume, const TriangleMesh& mesh,
                            const std::vector<Candidate>& candidates,
                            std::vector<Region>& regions) = 0;

  /// Releases the GL context that pick() leaves current in the calling thread. Another thread may
  /// then use or destroy the picker.
  virtual void release() = 0;

  /// The version and the platform of OpenGL, or a text which says that there is none.
  virtual const std::string& gl_version() const = 0;

  /// The faces that pick() has looked at one by one since the last reset_counts().
  const PickCounts& counts() const { return counts_; }
  void reset_counts() { counts_ = {}; }

 protected:
  PickCounts counts_;
};

/// Makes a picker, and tests it with three faces, only one of them in view. Throws GlError if
/// OpenGL gives no context or picks wrongly. No context is current afterwards.
std::unique_ptr<Picker> make_picker(const PickerSettings& settings);

/// Makes a picker that uses OpenGL, without testing it. It draws the faces that outcodes do not
/// decide. PickerKind::kFeedback draws them with one call in GL_FEEDBACK mode. PickerKind::kSelect
/// draws in GL_SELECT mode, as the 1999 paper does: each face under its own name. For a given
/// volume, it draws all faces of the mesh.
std::unique_ptr<Picker> new_gl_picker(const PickerSettings& settings);

}  // namespace organ_collision
