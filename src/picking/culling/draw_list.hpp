#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "outcodes.hpp"
#include "picking/volumes/part_sweep.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// A corner of a drawn face. What follows the position goes through GL as a texture coordinate.
struct DrawVertex {
  std::array<float, 3> position;     ///< in the volume's shifted coordinates [m]
  std::array<float, 2> barycentric;  ///< the corner's second and third; the first makes up to 1
  std::array<float, 2> number;       ///< the face's: lower and upper 16 bits, exact as floats
};

/// The number that was split over two floats.
std::uint32_t face_number(float lower, float upper);

/// Faces as GL is to draw them, in the order in which they were added. Keeps its memory.
class DrawList {
 public:
  /// Replaces the list by the faces of `mesh`, cluster by cluster, but for those that outcodes
  /// reject: whose three corners, or the boxes that hold these, are outside of one half-space.
  void assign(const ViewingVolume& volume, const TriangleMesh& mesh);

  /// Replaces the list by the faces of an organ that may meet a part during their motion, each
  /// drawn where it is half way. Returns the volume to draw them in: around the part, and grown by
  /// how far one of them moves from there, and for what 32 bits lose. A single face shall not make
  /// it large: those that move far, or that reach far from the part, are `undrawn`.
  ViewingVolume assign(const PartSweep& part, const OrganMotion& organ);

  /// Replaces the list by `faces`; they are numbered by their place in it.
  void assign(const ViewingVolume& volume, const TriangleMesh& mesh,
              const std::vector<std::uint32_t>& faces);

  const std::vector<DrawVertex>& vertices() const { return vertices_; }
  /// Numbers of faces that may meet the part, and that GL is not to decide on.
  const std::vector<std::uint32_t>& undrawn() const { return undrawn_; }

 private:
  template <typename Add>
  void for_each_face(const ViewingVolume& volume, const OrganMotion& organ, Add add);
  void add(const Triangle& face, std::uint32_t number);

  std::vector<DrawVertex> vertices_;
  std::vector<std::uint32_t> undrawn_;
  Outcodes outcodes_;
};

}  // namespace organ_collision
