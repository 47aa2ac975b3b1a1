#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "outcodes.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// The number of a face from its lower and its upper 16 bits, as DrawnFaces::Number holds them.
std::uint32_t face_number(float lower, float upper);

/// Faces as GL reads them. Each corner has the number of its face as a texture coordinate, which GL
/// returns. Positions and numbers are two arrays with different strides: see prepare_to_draw().
class DrawnFaces {
 public:
  using Position = std::array<float, 3>;  ///< in the volume's shifted coordinates [m]
  using Number = std::array<float, 2>;    ///< the lower and upper 16 bits; floats hold both exactly

  void clear();
  /// Adds a face in the volume's shifted coordinates.
  void add(const Triangle& face, std::uint32_t number);

  bool empty() const { return positions_.empty(); }
  std::size_t size() const { return positions_.size(); }
  std::uint32_t number(std::size_t face) const;

  /// The arrays for GL, with an element for each corner. There must be some faces.
  const Position& first_position() const { return positions_.front().front(); }
  const Number& first_number() const { return numbers_.front().front(); }

 private:
  std::vector<std::array<Position, 3>> positions_;
  std::vector<std::array<Number, 3>> numbers_;
};

/// The faces that GL draws, in the order in which they were added, and the volume to which GL clips
/// them. Keeps its memory between queries.
class DrawList {
 public:
  /// Replaces the list by the faces of `mesh` that outcodes do not reject, cluster by cluster.
  /// Outcodes reject a face if its three corners, or the boxes that contain them, are all outside
  /// the same half-space.
  void assign(const ViewingVolume& volume, const TriangleMesh& mesh);

  /// Replaces the list by all faces of `mesh`.
  void assign_all(const ViewingVolume& volume, const TriangleMesh& mesh);

  /// Replaces the list by the faces of an organ that may meet a part during their motion. Each face
  /// is drawn where it is half way. The volume contains the space that the part sweeps, grown by
  /// the largest distance of a drawn face from its place half way, and grown for 32-bit clipping.
  /// Some faces are listed in undrawn() instead: those with a corner inside, which meet the volume
  /// anyway, and those that move or reach so far that the volume would become large.
  void assign(const PartSweep& part, const OrganMotion& organ);

  /// Adds a face in the volume's shifted coordinates.
  void add(const Triangle& face, std::uint32_t number) { faces_.add(face, number); }

  const ViewingVolume& volume() const { return *volume_; }
  const DrawnFaces& faces() const { return faces_; }
  /// The numbers of the faces that may meet the part but are not drawn.
  const std::vector<std::uint32_t>& undrawn() const { return undrawn_; }

 private:
  void start(const ViewingVolume& volume, const OrganMotion& organ);
  void clear(const ViewingVolume& volume);

  std::optional<ViewingVolume> volume_;
  DrawnFaces faces_;
  std::vector<std::uint32_t> undrawn_;
  Outcodes outcodes_;
};

}  // namespace organ_collision
