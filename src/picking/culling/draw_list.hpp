#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "outcodes.hpp"
#include "picking/volumes/part_sweep.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// A corner of a drawn face. GL returns the number as a texture coordinate.
struct DrawVertex {
  std::array<float, 3> position;  ///< in the volume's shifted coordinates [m]
  std::array<float, 2> number;    ///< of the face: its lower and upper 16 bits, exact
};

/// The face's number from its lower and upper 16 bits.
std::uint32_t face_number(float lower, float upper);

/// The faces that GL draws, in the order in which they were added. Keeps its memory between
/// queries.
class DrawList {
 public:
  /// Replaces the list by the faces of `mesh` that outcodes do not reject, cluster by cluster.
  /// Outcodes reject a face if its three corners, or the boxes that contain them, are all outside
  /// the same half-space.
  void assign(const ViewingVolume& volume, const TriangleMesh& mesh);

  /// Replaces the list by all faces of `mesh`.
  void assign_all(const ViewingVolume& volume, const TriangleMesh& mesh);

  /// Replaces the list by the faces of an organ that may meet a part during their motion. Each face
  /// is drawn where it is half way. Returns the volume to clip them to: it contains the space that
  /// the part sweeps, and has grown by the largest distance of a drawn face from its place half
  /// way, and for 32-bit clipping. Faces with a corner inside need not be drawn.
  /// Faces that move far, or that reach far from the part, would make the volume large. Both are
  /// listed in undrawn().
  ViewingVolume assign(const PartSweep& part, const OrganMotion& organ);

  /// Adds a face in the volume's shifted coordinates.
  void add(const Triangle& face, std::uint32_t number);

  const std::vector<DrawVertex>& vertices() const { return vertices_; }
  /// Numbers of the faces that may meet the part and that GL does not decide on.
  const std::vector<std::uint32_t>& undrawn() const { return undrawn_; }

 private:
  void start(const ViewingVolume& volume, const OrganMotion& organ);

  std::vector<DrawVertex> vertices_;
  std::vector<std::uint32_t> undrawn_;
  Outcodes outcodes_;
};

}  // namespace organ_collision
