#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/picking/gl_error.hpp"
#include "organ_collision/picking/picker_settings.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// A face that meets a viewing volume, with the range of its depths behind the near plane, along
/// the view [m].
struct Candidate {
  std::uint32_t face;
  double view_min;
  double view_max;
};

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
  /// once, sorted by number. Contains every face that does. The depth ranges have no meaning.
  /// Throws as above.
  virtual void pick(const PartSweep& part, const OrganMotion& organ,
                    std::vector<Candidate>& candidates) = 0;

  /// To pick may leave a GL context current in the calling thread. Releases it, so that another
  /// thread may use or destroy the picker next.
  virtual void release() = 0;

  /// The version of OpenGL that draws, and its platform; or that there is none.
  virtual const std::string& gl_version() const = 0;
};

/// Makes a picker, and tests it with three faces, only one of them in view. Throws GlError if
/// OpenGL gives no context or picks wrongly. No context is current afterwards.
std::unique_ptr<Picker> make_picker(const PickerSettings& settings);

}  // namespace organ_collision
